#include "engine_bridge/scene/closed_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "engine_bridge/scene/triangle_source.h"
#include "shaders/closed_body_text.h"

namespace pellucid {
namespace {

constexpr std::size_t kBatch = 1024;
constexpr double kFlat = 1e-6;          // of the largest extent: thinner meshes have no inside
constexpr double kOnBox = 1e-4;         // by which corners may miss a box, as a part of half its edge
constexpr double kOnBall = 0.01;        // the same of a ball
constexpr double kInnermostFace = 0.8;  // of a ball's faces, whose middles lie within it: 10 or more around it
constexpr double kWraps = 1e-3;         // of the whole sphere

using Triangle = std::array<glm::dvec3, 3>;

std::vector<Triangle> trianglesOf(const Primitive& primitive) {
  std::vector<Triangle> triangles;
  VertexPlaces places;
  TriangleBatch batch;
  for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
    readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      Triangle& triangle = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) triangle[k] = glm::dvec3(batch.vertices[batch.indices[i + k]].position);
    }
  }
  return triangles;
}

// The part of the sphere that a triangle covers as seen from the middle, by its winding. Van Oosterom and Strackee 1983
double solidAngle(const Triangle& t) {
  const double a = glm::length(t[0]), b = glm::length(t[1]), c = glm::length(t[2]);
  const double volume = glm::dot(t[0], glm::cross(t[1], t[2]));
  return 2.0 *
         std::atan2(volume, a * b * c + glm::dot(t[0], t[1]) * c + glm::dot(t[1], t[2]) * a + glm::dot(t[2], t[0]) * b);
}

// Whether they lie around the middle once, without a hole and without a fold.
bool wrapsOnce(const std::vector<Triangle>& triangles) {
  double turned = 0.0, all = 0.0;
  for (const Triangle& triangle : triangles) {
    const double angle = solidAngle(triangle);
    turned += angle;
    all += std::abs(angle);
  }
  const double sphere = 4.0 * glm::pi<double>();
  return std::abs(std::abs(turned) - sphere) < kWraps * sphere && std::abs(all - sphere) < kWraps * sphere;
}

double boxNorm(const glm::dvec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// Corners lie on the surface where `norm` is 1, and middles of faces hardly within it.
template <class Norm>
bool liesOn(const std::vector<Triangle>& triangles, const Norm& norm, double off, double innermost) {
  return std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return norm((t[0] + t[1] + t[2]) / 3.0) >= innermost &&
           std::all_of(t.begin(), t.end(), [&](const glm::dvec3& p) { return std::abs(norm(p) - 1.0) <= off; });
  });
}

}  // namespace

std::optional<SolidBody> closedBodyOf(const Primitive& primitive) {
  if (primitive.points || primitive.triangles() == 0 || primitive.triangles() > kMostFitted) return std::nullopt;
  std::vector<Triangle> triangles = trianglesOf(primitive);
  glm::dvec3 low(triangles[0][0]), high = low;
  for (const Triangle& triangle : triangles)
    for (const glm::dvec3& p : triangle) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  const glm::dvec3 half = 0.5 * (high - low), middle = 0.5 * (high + low);
  if (!(std::min({half.x, half.y, half.z}) > kFlat * boxNorm(half))) return std::nullopt;
  for (Triangle& triangle : triangles)
    for (glm::dvec3& p : triangle) p = (p - middle) / half;
  SolidBody body;
  if (liesOn(triangles, boxNorm, kOnBox, 1.0 - kOnBox))
    body.kind = shading::PLD_BODY_BOX;
  else if (liesOn(
               triangles, [](const glm::dvec3& p) { return glm::length(p); }, kOnBall, kInnermostFace))
    body.kind = shading::PLD_BODY_BALL;
  if (body.kind == shading::PLD_BODY_NONE || !wrapsOnce(triangles)) return std::nullopt;
  body.fromObject = glm::translate(glm::scale(glm::dmat4(1.0), 1.0 / half), -middle);
  return body;
}

}  // namespace pellucid
