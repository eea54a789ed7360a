// Triangles under rays, and the coats on them.
#pragma once
#include <optional>

#include "tests/reference/closed_solids.h"
#include "tests/reference/lit_surfaces.h"

namespace pellucid::reference {

// Where a ray meets a triangle: the shares of its corners, and planar depth.
struct Within {
  Vec3 shares;
  double z;
  double facing;  // cosine between ray and normal, below 0 from the front
  Vec3 normal;    // unit, of the front
};
std::optional<Within> meet(const Ray& ray, const Vec3 (&corners)[3]);
// Of the plane of a triangle, also beyond its edges.
Vec3 sharesOf(const Ray& ray, const Vec3 (&corners)[3]);

// In the texture of a coat.
Vec2 placeOf(const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares);
// Straight colour of a coat.
Vec4 colourOf(const PictureScene& scene, const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares);
Finished finishedOf(const Coat& coat, const Vec4& colour);
// Of light that enters by the front.
Vec3 leftByFilling(const Filling& filling);
// Light leaves a filled mesh by its backs.
bool hasBothSides(const Coat& coat);

}  // namespace pellucid::reference
