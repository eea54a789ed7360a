// Depth and ambient occlusion of what is opaque in a picture: the G-buffer, and solid leaves that it lacks.
#pragma once
#include <cstdint>

#include "composite/screen_occlusion.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/occluders.h"

namespace pellucid {

// The nearer of the G-buffer and of solids before it by more than depths of one surface differ.
struct NearestSolids {
  Image<float> viewZ;           // planar metres, +inf for nothing
  Image<std::uint8_t> lacking;  // 1 where the G-buffer lacks the solid
  std::size_t lacked = 0;       // such pixels
};
//   solidZ  nearest solids, of the G-buffer's data window, planar metres; +inf, or what is no depth, for none
NearestSolids nearestSolids(const GBuffer& gbuffer, const Image<float>& solidZ);

struct OccluderSettings {
  bool fromFile = true;  // takes the G-buffer's own occlusion where it has some
  ScreenOcclusionSettings screen;
};

// Occlusion of the solids that the G-buffer lacks comes from the depth of both together, as does that of the G-buffer
// where it brings none.
//   wanted     pixels that matter; nullptr wants all
//   fromDepth  how many were computed
OccluderPlanes occludersOf(const GBuffer& gbuffer, const Camera& camera, NearestSolids solids,
                           const OccluderSettings& settings, const Image<std::uint8_t>* wanted, std::size_t& fromDepth);

}  // namespace pellucid
