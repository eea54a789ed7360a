// The fog of a request, ready for one shot.
#pragma once
#include <memory>

#include "composite/pipeline/air.h"

namespace pellucid {

// A fog where it lies, before anything is known of what stands in its light.
struct PlacedFog {
  std::shared_ptr<const Fog> fog;  // null when off
  MediumSettings medium;
  int shafts = 0;
};

// Throws UsageError, MeaningError (no camera to march along), and what readDensityGrid throws.
//   scatter  how far layers diffuse
PlacedFog placeFogOf(const FogRequest& request, const ScatterSettings& scatter, const Shot& shot, double metresPerUnit,
                     Journal& journal);

// The same fog with what surfaces, particles and its own grid leave of the lights in it. Null when off.
std::shared_ptr<const Fog> lightFog(const PlacedFog& placed, const Shot& shot, Air& air, Journal& journal);

}  // namespace pellucid
