#include "engine_bridge/scene/placed.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr double kFlat = 1e-12;  // of the product of its axes' lengths: what rounding leaves of a volume of 0

// Eye to origin over the nearest distance: from there on what floats round of a point is more than float depth tells.
constexpr double kFar = 8.0;

// Carries normals; unlike the inverse transpose it stands a flattened (singular) matrix.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// As large as it was, its axes the camera's. What was mirrored stays so, as the loader has turned its triangles.
void faceCamera(glm::dmat4& viewFromObject) {
  const double hand = mirrors(viewFromObject) ? -1.0 : 1.0;
  for (int c = 0; c < 3; ++c) {
    const double size = glm::length(glm::dvec3(viewFromObject[c]));
    viewFromObject[c] = glm::dvec4(0.0);
    viewFromObject[c][c] = c == 0 ? hand * size : size;
  }
}

}  // namespace

bool mirrors(const glm::dmat4& transform) {
  const glm::dvec3 x(transform[0]), y(transform[1]), z(transform[2]);
  return glm::dot(glm::cross(x, y), z) < -kFlat * glm::length(x) * glm::length(y) * glm::length(z);
}

double uniformScale(const glm::dmat4& transform) {
  const glm::dmat3 linear(transform);
  const double volume = std::abs(glm::determinant(linear));
  const double cube = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (volume > kFlat * cube) return std::cbrt(volume);
  const glm::dmat3 areas = cofactors(linear);
  return std::sqrt(std::max({glm::length(areas[0]), glm::length(areas[1]), glm::length(areas[2])}));
}

PlacedNearEye placedNearEye(const glm::dmat4& viewFromObject, double nearest) {
  PlacedNearEye placed;
  const glm::dmat3 linear(viewFromObject);
  const double cube = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  glm::dmat4 offset = viewFromObject;
  const bool far = glm::length(glm::dvec3(viewFromObject[3])) > kFar * nearest;
  if (far && std::abs(glm::determinant(linear)) > kFlat * cube) {
    const glm::vec3 eye(-(glm::inverse(linear) * glm::dvec3(viewFromObject[3])));
    if (std::isfinite(eye.x + eye.y + eye.z)) {
      placed.origin = eye;
      offset[3] = glm::dvec4(glm::dvec3(viewFromObject[3]) + linear * glm::dvec3(eye), 1.0);
    }
  }
  placed.viewFromOffset = glm::mat4(offset);
  return placed;
}

std::vector<Placed> placeInstances(const Scene& scene, const Camera& camera) {
  std::vector<Placed> all;
  all.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    Placed placed;
    placed.viewFromObject = camera.viewFromWorld * instance.worldFromObject;
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
    if (scene.materials.at(static_cast<std::size_t>(primitive.material)).billboard) faceCamera(placed.viewFromObject);
    placed.colour = instance.colour;
    const glm::dmat3 linear(placed.viewFromObject);
    glm::dmat3 normal = cofactors(linear);
    double largest = 0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(normal[c][r]));
    if (largest > 0) normal *= (mirrors(placed.viewFromObject) ? -1.0 : 1.0) / largest;
    placed.normalFromObject = glm::mat3(normal);
    placed.thicknessScale = static_cast<float>(uniformScale(placed.viewFromObject));
    all.push_back(placed);
  }
  return all;
}

}  // namespace pellucid
