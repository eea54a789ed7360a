#include "engine_bridge/embree/triangle.h"

#include <cmath>

namespace pellucid::rays {
namespace {

bool before(const glm::dvec3& p, const glm::dvec3& q) {
  if (p.x != q.x) return p.x < q.x;
  if (p.y != q.y) return p.y < q.y;
  return p.z < q.z;
}

struct Edge {
  double value;  // > 0 where the ray passes on one side of p -> q, < 0 on the other
  int side;      // the same, never 0 unless the ray lies in the edge's plane whichever way it is nudged
};

int signOf(double value) {
  return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}

// Both triangles of an edge compute it from the same end, so that their values are exactly opposite.
Edge edge(const Ray& ray, const glm::dvec3& p, const glm::dvec3& q, bool orthographic) {
  const bool turned = before(q, p);
  const glm::dvec3 a = (turned ? q : p) - ray.origin, b = (turned ? p : q) - ray.origin;
  const glm::dvec3 moment = glm::cross(a, b);
  const double value = glm::dot(ray.direction, moment);
  int side = signOf(value);
  // What the value would become for a ray a little to the right, then a little down.
  if (side == 0) side = signOf(orthographic ? (b - a).y : moment.x);
  if (side == 0) side = signOf(orthographic ? (b - a).x : -moment.y);
  return turned ? Edge{-value, -side} : Edge{value, side};
}

std::optional<TriangleHit> hitOf(const double (&value)[3], const Corners& corners) {
  const double sum = value[0] + value[1] + value[2];
  if (sum == 0.0 || !std::isfinite(sum)) return std::nullopt;
  TriangleHit hit;
  hit.front = sum < 0.0;
  for (int i = 0; i < 3; ++i) {
    hit.weight[i] = value[i] / sum;
    hit.z -= hit.weight[i] * corners.p[i].z;
  }
  return hit;
}

}  // namespace

Corners cornersOf(const Primitive& primitive, const glm::dmat4& viewFromObject, std::size_t triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& vertex = primitive.vertices[primitive.indices[3 * triangle + i]];
    corners.p[i] = glm::dvec3(viewFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0));
  }
  return corners;
}

std::optional<TriangleHit> intersectHalfOpen(const Ray& ray, const Corners& corners, bool orthographic) {
  double value[3];
  int side = 0;
  for (int i = 0; i < 3; ++i) {
    const Edge opposite = edge(ray, corners.p[(i + 1) % 3], corners.p[(i + 2) % 3], orthographic);
    value[i] = opposite.value;
    if (opposite.side == 0 || (i > 0 && opposite.side != side)) return std::nullopt;
    side = opposite.side;
  }
  return hitOf(value, corners);
}

std::optional<TriangleHit> intersectPlane(const Ray& ray, const Corners& corners) {
  double value[3];
  for (int i = 0; i < 3; ++i) value[i] = edge(ray, corners.p[(i + 1) % 3], corners.p[(i + 2) % 3], false).value;
  return hitOf(value, corners);
}

}  // namespace pellucid::rays
