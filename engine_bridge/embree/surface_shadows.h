// What reaches transparent surfaces of the lights, exactly: rays through transparent and opaque things from every point
// that is shaded. What shadow maps approximate there.
#pragma once
#include <memory>

#include "engine_bridge/embree/shadow_rays.h"
#include "engine_bridge/scene/light_volume.h"

namespace pellucid {

// Opaque are the scene's opaque primitives or, without any, the surface that the G-buffer shows, which a point is held
// two pixels off. The arguments must outlive the result. Throws ResourceError.
//   rays  of the same scene and camera
SurfaceVisibility surfaceShadows(const Scene& scene, const Camera& camera, const GBuffer& gbuffer,
                                 std::shared_ptr<const ShadowRays> rays);

}  // namespace pellucid
