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
  glm::vec4 colour{1.0f};            // Instance::colour
};
// Whether a transform turns triangles inside out. One that flattens does not, however it is rounded.
bool mirrors(const glm::dmat4& transform);

// Metres per unit of object space: the cube root of what a volume grows by; of a transform that flattens, the square
// root of what an area does.
double uniformScale(const glm::dmat4& transform);

// One for each of scene.instances.
std::vector<Placed> placeInstances(const Scene& scene, const Camera& camera);

}  // namespace pellucid
