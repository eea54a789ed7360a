// The light on transparent surfaces, where something has to be asked for it at every fragment.
#pragma once
#include "composite/pipeline/shadow_step.h"

namespace pellucid {

// What reaches the shot's transparent surfaces of the lights, asked for every fragment: past surfaces by rays, or by
// maps where fog has to be asked as well, which they do not hold; past fog and particles. Null where maps alone know,
// without shadows, and where no such surface is lit. The arguments must outlive it.
std::shared_ptr<const SurfaceVisibility> surfaceLight(const CastShadows& shadows, const Shot& shot,
                                                      std::shared_ptr<const Fog> fog);

}  // namespace pellucid
