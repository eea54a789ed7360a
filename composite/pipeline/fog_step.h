// The fog of a request, ready for one shot.
#pragma once
#include <memory>

#include "composite/pipeline/air.h"

namespace pellucid {

// What a list key=value,... says. Throws UsageError.
FogText readFogText(const std::string& text);
// The same keys of a JSON file with one object. Throws InputError.
FogText readFogFile(const std::string& path);
extern const char* const kFogKeys;  // for help

// What can be said of it without a file. Throws UsageError.
void checkFog(const FogText& text, bool hasGrid);

// A fog where it lies, before anything is known of what stands in its light.
struct PlacedFog {
  std::shared_ptr<const Fog> fog;  // null when off
  MediumSettings medium;
  int shafts = 0;
};

// Throws UsageError, MeaningError (no camera to march along), and what readDensityGrid throws.
PlacedFog placeFogOf(const FogRequest& request, const Shot& shot, double metresPerUnit, Journal& journal);

// The same fog with what surfaces, particles and its own grid leave of the lights in it. Null when off.
std::shared_ptr<const Fog> lightFog(const PlacedFog& placed, const Shot& shot, Air& air, Journal& journal);

}  // namespace pellucid
