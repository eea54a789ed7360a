#include "composite/picture_occluders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/shading.h"

namespace pellucid {

NearestSolids nearestSolids(const GBuffer& gbuffer, const Image<float>& solidZ) {
  NearestSolids solids;
  solids.viewZ = gbuffer.viewZ;
  solids.lacking = Image<std::uint8_t>(solidZ.width(), solidZ.height());
  for (std::size_t i = 0; i < solidZ.size(); ++i) {
    if (!std::isfinite(solidZ[i]) || !shading::standsBefore(solidZ[i], solids.viewZ[i])) continue;
    solids.viewZ[i] = solidZ[i];
    solids.lacking[i] = 1;
    ++solids.lacked;
  }
  return solids;
}

OccluderPlanes occludersOf(const GBuffer& gbuffer, const Camera& camera, NearestSolids solids,
                           const OccluderSettings& settings, const Image<std::uint8_t>* wanted,
                           std::size_t& fromDepth) {
  OccluderPlanes occluders;
  occluders.data = gbuffer.data;
  const bool fromFile = settings.fromFile && !gbuffer.occlusion.empty();
  Image<std::uint8_t> computed = wanted ? *wanted : Image<std::uint8_t>(solids.viewZ.width(), solids.viewZ.height(), 1);
  fromDepth = 0;
  for (std::size_t i = 0; i < computed.size(); ++i) {
    if ((fromFile && !solids.lacking[i]) || !(solids.viewZ[i] <= 1e30f)) computed[i] = 0;
    fromDepth += computed[i];
  }
  occluders.occlusion = fromFile ? gbuffer.occlusion : Image<float>(solids.viewZ.width(), solids.viewZ.height(), 1.0f);
  if (fromDepth > 0) {
    const Image<float> screen =
        screenOcclusion(solids.viewZ, camera, gbuffer.display, gbuffer.data, settings.screen, &computed);
    for (std::size_t i = 0; i < computed.size(); ++i)
      if (computed[i]) occluders.occlusion[i] = screen[i];
  }
  occluders.viewZ = std::move(solids.viewZ);
  for (std::size_t i = 0; i < occluders.occlusion.size(); ++i) {
    float& open = occluders.occlusion[i];
    if (!std::isfinite(open)) occluders.viewZ[i] = std::numeric_limits<float>::infinity();  // weighs nothing
    open = std::isfinite(open) ? std::clamp(open, 0.0f, 1.0f) : 1.0f;
  }
  return occluders;
}

}  // namespace pellucid
