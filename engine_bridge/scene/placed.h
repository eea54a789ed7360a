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
// The same for arithmetic in floats: points are taken from `origin` before they are transformed. That is where the eye
// stands, as a float, so that what is left of a point is as precise as it is near, however far from the origin of its
// object's coordinates both lie.
struct PlacedNearEye {
  glm::vec3 origin{0.0f};          // object space
  glm::mat4 viewFromOffset{1.0f};  // of a point less the origin
};
// Of a transform that flattens, the origin is the object's, and where the eye is not so far from it that it would tell.
//   nearest  metres from the eye to what has to be told apart by the precision of float depth; 0: as near as can be
PlacedNearEye placedNearEye(const glm::dmat4& viewFromObject, double nearest);

// Whether a transform turns triangles inside out. One that flattens does not, however it is rounded.
bool mirrors(const glm::dmat4& transform);

// Metres per unit of object space: the cube root of what a volume grows by; of a transform that flattens, the square
// root of what an area does.
double uniformScale(const glm::dmat4& transform);

// One for each of scene.instances.
std::vector<Placed> placeInstances(const Scene& scene, const Camera& camera);

}  // namespace pellucid
