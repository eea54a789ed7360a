// A ray and one triangle, in double precision, with every edge given to exactly one of the triangles that share it.
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "engine_bridge/embree/camera_rays.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::rays {

struct Corners {
  glm::dvec3 p[3];  // view space
};
Corners cornersOf(const Primitive& primitive, const glm::dmat4& viewFromObject, std::size_t triangle);

struct TriangleHit {
  double z = 0;           // planar metres
  double weight[3] = {};  // of the corners; they sum to 1
  bool front = true;      // counter-clockwise as the eye sees it
};

// Half open: a ray that meets an edge or a corner exactly is taken as if it ran a hair to the right, and then a hair
// down, in the picture. So a closed mesh is hit once wherever it is hit, on the sides that a rasteriser's top-left rule
// takes. Nothing for a ray that misses or runs within the plane. z may be negative.
std::optional<TriangleHit> intersectHalfOpen(const Ray& ray, const Corners& corners, bool orthographic);

// Where the ray meets the triangle's plane, in or out of the triangle; for derivatives, and to refine a hit that is
// known. Nothing for a ray that runs within the plane.
std::optional<TriangleHit> intersectPlane(const Ray& ray, const Corners& corners);

}  // namespace pellucid::rays
