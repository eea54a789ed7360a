// Rays, and what they meet of solids, in closed form.
#pragma once
#include <limits>
#include <optional>

#include "tests/reference/picture_scene.h"

namespace pellucid::reference {

constexpr double kNothing = std::numeric_limits<double>::infinity();

// `along` goes 1 along the eye's axis, so that a distance along the ray is planar depth.
struct Ray {
  Vec3 from, along;
};
//   x, y  in pixels of the picture, y down
Ray rayThrough(const Eye& eye, double x, double y);

struct Met {
  double z = kNothing;  // planar depth, above 0
  Face face;
};
Met nearestSolid(const PictureScene& scene, const Ray& ray);

// Depth of a flat face's whole plane; nothing of a ball, and where the plane lies behind the eye.
std::optional<double> depthOfPlane(const PictureScene& scene, const Face& face, const Ray& ray);

}  // namespace pellucid::reference
