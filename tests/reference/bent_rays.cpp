#include "tests/reference/bent_rays.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

// Behind a surface, in its depths, or in pixels of parallel rays: nothing lies farther, the sky neither.
constexpr double kFarthest = 1e4, kFarthestParallel = 1e6;
constexpr double kLeastForward = 0.02;  // of a ray that goes more sideways

// Pixels from the picture's middle, y down.
Vec2 projected(const Eye& eye, const Vec3& at) {
  const Vec2 part = Vec2(at) / (eye.parallel ? 1.0 : std::max(-at.z, 1e-7)) / eye.half;
  return {0.5 * part.x * eye.displayWidth, -0.5 * part.y * eye.displayHeight};
}

// Snell's law: what goes across the surface shrinks by the index.
Vec3 entering(const Vec3& toEye, const Vec3& normal, double index) {
  const Vec3 across = (glm::dot(toEye, normal) * normal - toEye) / index;
  return across - std::sqrt(std::max(1.0 - glm::dot(across, across), 0.0)) * normal;
}

Vec3 reachedFrom(const Eye& eye, const Bending& bending, const Bend& bend, double index, double backgroundZ) {
  const Vec3 inside = entering(bend.toEye, bend.normal, index);
  const double farthest =
      eye.parallel ? kFarthestParallel * 2.0 * eye.half.x / eye.displayWidth : kFarthest * -bend.at.z;
  const double behind = std::clamp(backgroundZ + bend.at.z, 0.0, std::max(farthest, 0.0));
  if (bending.until == Bending::Until::slab) {
    const Vec3 leaves = bend.at + inside * (bend.thickness / std::max(-glm::dot(inside, bend.normal), kLeastForward));
    const double left = std::max(behind + leaves.z - bend.at.z, 0.0);
    return leaves - bend.toEye * (left / std::max(bend.toEye.z, kLeastForward));
  }
  const double way = bending.until == Bending::Until::distance ? bending.distance : behind;
  return bend.at + inside * (way / std::max(-inside.z, kLeastForward));
}

}  // namespace

Vec3 dispersedIndex(double index, double dispersion) {
  const double half = (index - 1.0) * 0.025 * dispersion;
  return glm::max(Vec3(index - half, index, index + half), Vec3(1.0));
}

Landing landingOf(const Eye& eye, const Bending& bending, const std::vector<Bend>& bends, double backgroundZ,
                  Vec2 tilt) {
  Landing landing;
  double weights = 0.0;
  for (Bend bend : bends) {
    bend.normal = glm::normalize(bend.normal + Vec3(tilt, 0.0));
    const Vec2 here = projected(eye, bend.at);
    for (glm::length_t c = 0; c < 3; ++c) {
      const Vec2 there = projected(eye, reachedFrom(eye, bending, bend, bend.index[c], backgroundZ));
      landing.offset[static_cast<std::size_t>(c)] += bend.weight * (there - here);
      landing.reach = std::max(landing.reach, glm::length(there) + glm::length(here));
    }
    landing.z -= bend.weight * bend.at.z;
    weights += bend.weight;
  }
  for (Vec2& offset : landing.offset) offset /= weights;
  landing.z /= weights;
  return landing;
}

double reflectedPart(double cosine, double index) {
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const double across = (cosine - index * inside) / (cosine + index * inside);
  const double along = (index * cosine - inside) / (index * cosine + inside);
  return 0.5 * (across * across + along * along);
}

}  // namespace pellucid::reference
