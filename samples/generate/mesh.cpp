#include "samples/generate/mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace pellucid::samples {
namespace {

// A point of the curve and its outward normal, in the (radius, height) plane.
struct Rib {
  glm::dvec2 point, normal;
};

std::vector<Rib> ribs(const std::vector<glm::dvec2>& profile, int steps) {
  const int last = static_cast<int>(profile.size()) - 1;
  const auto at = [&](int i) { return profile[static_cast<std::size_t>(std::clamp(i, 0, last))]; };
  std::vector<Rib> out;
  for (int i = 0; i < last; ++i) {
    const glm::dvec2 p = at(i), q = at(i + 1), tangentP = 0.5 * (q - at(i - 1)), tangentQ = 0.5 * (at(i + 2) - p);
    for (int k = 0; k < steps + (i + 1 == last ? 1 : 0); ++k) {
      const double t = static_cast<double>(k) / steps, t2 = t * t, t3 = t2 * t;
      glm::dvec2 point =
          (2 * t3 - 3 * t2 + 1) * p + (t3 - 2 * t2 + t) * tangentP + (3 * t2 - 2 * t3) * q + (t3 - t2) * tangentQ;
      const glm::dvec2 slope =
          (6 * t2 - 6 * t) * p + (3 * t2 - 4 * t + 1) * tangentP + (6 * t - 6 * t2) * q + (3 * t2 - 2 * t) * tangentQ;
      point.x = std::max(point.x, 0.0);
      out.push_back({point, glm::normalize(glm::dvec2(slope.y, -slope.x))});
    }
  }
  return out;
}

}  // namespace

void addQuad(Mesh& mesh, glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal(glm::normalize(glm::cross(right, up)));
  for (const glm::dvec2 uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
    mesh.positions.emplace_back(corner + uv.x * right + uv.y * up);
    mesh.normals.push_back(normal);
    mesh.uvs.emplace_back(uv.x, 1.0 - uv.y);
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

Mesh lathe(const std::vector<glm::dvec2>& profile, int steps, int segments) {
  Mesh mesh;
  const std::vector<Rib> curve = ribs(profile, steps);
  for (const Rib& rib : curve)
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * glm::pi<double>() * s / segments, c = std::cos(angle), d = -std::sin(angle);
      mesh.positions.emplace_back(rib.point.x * c, rib.point.y, rib.point.x * d);
      mesh.normals.emplace_back(rib.normal.x * c, rib.normal.y, rib.normal.x * d);
    }
  const auto index = [&](std::size_t ring, int s) {
    return static_cast<std::uint32_t>(ring * static_cast<std::size_t>(segments) +
                                      static_cast<std::size_t>(s % segments));
  };
  for (std::size_t ring = 0; ring + 1 < curve.size(); ++ring)
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t a = index(ring, s), b = index(ring, s + 1), c = index(ring + 1, s + 1),
                          d = index(ring + 1, s);
      if (curve[ring].point.x > 0.0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (curve[ring + 1].point.x > 0.0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
  return mesh;
}

}  // namespace pellucid::samples
