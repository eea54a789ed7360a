// Inferred occlusion of rims whose light from around lies apart: MODEL section 10, after the pass instead of in it.
#pragma once
#include <cstddef>

#include "gbuffer/accum.h"
#include "gbuffer/occluders.h"
#include "gbuffer/rim_planes.h"

namespace pellucid {

// Takes from the sums what the opaque pixels beside the rims hide. One rim in a pixel gets what the pass would have
// given it; several share the answer for their mean depth and gradient. Returns how many pixels have rims.
//   form  PLD_OCCLUSION_RELATIVE or PLD_OCCLUSION_PUBLISHED
// Throws std::logic_error when the windows differ.
std::size_t occludeRims(const RimPlanes& rims, const OccluderPlanes& occluders, int form, OitPlanes& planes);

}  // namespace pellucid
