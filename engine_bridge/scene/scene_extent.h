// Where a scene's transparent things lie in a picture, for what is said of them.
#pragma once
#include <cstddef>
#include <optional>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

struct SceneExtent {
  glm::dvec3 least{0.0}, most{0.0};            // metres, world
  double nearest = 0, farthest = 0;            // planar metres of what lies before the eye
  std::size_t inPicture = 0, beforeDepth = 0;  // corners and middles of triangles: in the data window; of them before
                                               // what the picture shows
};

// Of transparent triangles; of scenes of many, of some of them. Nothing where there are none.
std::optional<SceneExtent> extentOf(const Scene& scene, const Camera& camera, const GBuffer& gbuffer);

}  // namespace pellucid
