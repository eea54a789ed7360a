// Instances as one camera sees them.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid {

struct Placed {
  glm::dmat4 viewFromObject{1.0};
  glm::mat3 normalFromObject{1.0f};  // carries normals to view space, any length, on the side they were
  float thicknessScale = 1.0f;       // metres per unit of object space
};
// One for each of scene.instances.
std::vector<Placed> placeInstances(const Scene& scene, const Camera& camera);

}  // namespace pellucid
