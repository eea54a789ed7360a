// Opaque G-buffers by rasterisation.
#pragma once
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/opaque_planes.h"

namespace pellucid {

struct OpaquePassSettings {
  TextureFilter filter = TextureFilter::mipmap;
  glm::vec3 surroundings{0.0f};                      // constant environment radiance, scene-linear
  std::size_t budgetBytes = std::size_t{256} << 20;  // geometry that stays on the device between passes
};

// The opaque primitives of the scene at pixel centres: the planes of renderOpaque without AO, with lights and
// surroundings that nothing is in the way of. Throws ResourceError when the device has no room.
OpaquePlanes rasteriseOpaque(GlContext& context, const Scene& scene, const Camera& camera, const Window& display,
                             const Window& data, const OpaquePassSettings& settings);

}  // namespace pellucid
