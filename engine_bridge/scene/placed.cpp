#include "engine_bridge/scene/placed.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

// Carries normals; unlike the inverse transpose it stands a flattened (singular) matrix.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

std::vector<Placed> placeInstances(const Scene& scene, const Camera& camera) {
  std::vector<Placed> all;
  all.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    Placed placed;
    placed.viewFromObject = camera.viewFromWorld * instance.worldFromObject;
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
    if (scene.materials.at(static_cast<std::size_t>(primitive.material)).billboard)
      for (int c = 0; c < 3; ++c) {  // as large as it was, its axes the camera's
        const double size = glm::length(glm::dvec3(placed.viewFromObject[c]));
        placed.viewFromObject[c] = glm::dvec4(0.0);
        placed.viewFromObject[c][c] = size;
      }
    const glm::dmat3 linear(placed.viewFromObject);
    const double volume = glm::determinant(linear);
    glm::dmat3 normal = cofactors(linear);
    double largest = 0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(normal[c][r]));
    if (largest > 0) normal *= (volume < 0 ? -1.0 : 1.0) / largest;
    placed.normalFromObject = glm::mat3(normal);
    placed.thicknessScale = static_cast<float>(std::cbrt(std::abs(volume)));
    all.push_back(placed);
  }
  return all;
}

}  // namespace pellucid
