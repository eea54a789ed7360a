#include "tests/reference/triangles.h"

#include <cmath>

#include "tests/reference/texels.h"

namespace pellucid::reference {
namespace {

// The volumes that a ray spans with a triangle's edges.
Vec3 volumesOf(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 p = corners[0] - ray.from, q = corners[1] - ray.from, r = corners[2] - ray.from;
  return {glm::dot(ray.along, glm::cross(q, r)), glm::dot(ray.along, glm::cross(r, p)),
          glm::dot(ray.along, glm::cross(p, q))};
}

}  // namespace

// All of them have one sign where the ray passes between the edges.
std::optional<Within> meet(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 volumes = volumesOf(ray, corners);
  const bool above = volumes.x > 0.0 && volumes.y > 0.0 && volumes.z > 0.0;
  const bool below = volumes.x < 0.0 && volumes.y < 0.0 && volumes.z < 0.0;
  if (!above && !below) return std::nullopt;
  const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double z = glm::dot(normal, corners[0] - ray.from) / glm::dot(normal, ray.along);
  if (!(z > 0.0)) return std::nullopt;
  return Within{volumes / (volumes.x + volumes.y + volumes.z), z,
                glm::dot(normal, ray.along) / (glm::length(normal) * glm::length(ray.along)), glm::normalize(normal)};
}

Vec3 sharesOf(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 volumes = volumesOf(ray, corners);
  return volumes / (volumes.x + volumes.y + volumes.z);
}

Vec2 placeOf(const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares) {
  Vec2 uv(0.0);
  for (int k = 0; k < 3; ++k)
    uv += shares[k] * mesh.corners[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])].uv;
  return Vec2(mesh.coat.fromUv * Vec3(uv, 1.0));
}

Vec4 colourOf(const PictureScene& scene, const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares) {
  const auto at = [&](std::size_t k) { return mesh.corners[static_cast<std::size_t>(triangle[k])].colour; };
  // What all corners have is just that, and what is opaque hides everything.
  Vec4 colour = at(0) + shares[1] * (at(1) - at(0)) + shares[2] * (at(2) - at(0));
  const Coat& coat = mesh.coat;
  colour *= coat.colour;
  if (coat.texture >= 0)
    colour *= texelAt(scene.textures[static_cast<std::size_t>(coat.texture)], placeOf(mesh, triangle, shares));
  return colour;
}

Finished finishedOf(const Coat& coat, const Vec4& colour) {
  const Finish& finish = coat.finish;
  return {Vec3(colour),        coat.glass ? finish.passes : 0.0, finish.metal, finish.roughness, coat.filling.index,
          coat.filling.mirrors};
}

Vec3 leftByFilling(const Filling& filling) {
  return glm::pow(filling.colour, Vec3(filling.thickness / filling.clearness));
}

bool hasBothSides(const Coat& coat) {
  return coat.bothSides || (coat.glass && coat.filling.thickness > 0.0);
}

}  // namespace pellucid::reference
