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

// Null when off. Throws UsageError, MeaningError (no camera to march along), and what readDensityGrid throws.
std::shared_ptr<const Fog> placeFogOf(const FogRequest& request, const Shot& shot, double metresPerUnit, Air& air,
                                      Journal& journal);

}  // namespace pellucid
