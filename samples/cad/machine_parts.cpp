#include "samples/cad/machine_parts.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace pellucid::samples {
namespace {

constexpr double kTurn = 2.0 * glm::pi<double>();
constexpr int kRound = 28;  // sides of what is round

std::vector<glm::dvec2> circle(double radius, int sides) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < sides; ++i)
    points.emplace_back(radius * std::cos(kTurn * i / sides), -radius * std::sin(kTurn * i / sides));
  return points;
}

void addFace(Mesh& mesh, const std::vector<glm::dvec3>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal(glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
  for (const glm::dvec3& corner : corners) {
    mesh.positions.emplace_back(corner);
    mesh.normals.push_back(normal);
  }
  for (std::uint32_t i = 2; i < corners.size(); ++i)
    mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
}

}  // namespace

void add(Mesh& mesh, const Mesh& part, const glm::dmat4& place) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    mesh.positions.emplace_back(place * glm::dvec4(glm::dvec3(part.positions[i]), 1.0));
    mesh.normals.emplace_back(glm::normalize(glm::dmat3(place) * glm::dvec3(part.normals[i])));
  }
  for (const std::uint32_t i : part.indices) mesh.indices.push_back(first + i);
}

glm::dmat4 moved(glm::dvec3 by) {
  return glm::translate(glm::dmat4(1.0), by);
}
glm::dmat4 alongX() {
  return glm::rotate(glm::dmat4(1.0), -kTurn / 4.0, glm::dvec3(0.0, 0.0, 1.0));
}
glm::dmat4 alongZ() {
  return glm::rotate(glm::dmat4(1.0), kTurn / 4.0, glm::dvec3(1.0, 0.0, 0.0));
}
glm::dmat4 turnedX(double angle) {
  return glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(1.0, 0.0, 0.0));
}

Mesh prism(const std::vector<glm::dvec2>& outline, double half) {
  Mesh mesh;
  std::vector<glm::dvec3> top, bottom;
  for (const glm::dvec2& p : outline) top.emplace_back(p.x, half, p.y);
  for (auto p = outline.rbegin(); p != outline.rend(); ++p) bottom.emplace_back(p->x, -half, p->y);
  addFace(mesh, top);
  addFace(mesh, bottom);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    addFace(mesh, {{a.x, -half, a.y}, {b.x, -half, b.y}, {b.x, half, b.y}, {a.x, half, a.y}});
  }
  return mesh;
}

Mesh boxOf(glm::dvec3 half) {
  return prism({{-half.x, half.z}, {half.x, half.z}, {half.x, -half.z}, {-half.x, -half.z}}, half.y);
}

Mesh cylinderOf(double radius, double half) {
  return prism(circle(radius, kRound), half);
}

Mesh ring(double inner, double outer, double half) {
  Mesh mesh;
  for (int i = 0; i < kRound; ++i) {
    const auto at = [&](int k, double radius, double y) {
      const double angle = kTurn * (i + k) / kRound;
      return glm::dvec3(radius * std::cos(angle), y, -radius * std::sin(angle));
    };
    addFace(mesh, {at(0, outer, -half), at(1, outer, -half), at(1, outer, half), at(0, outer, half)});
    addFace(mesh, {at(1, inner, -half), at(0, inner, -half), at(0, inner, half), at(1, inner, half)});
    addFace(mesh, {at(0, inner, half), at(0, outer, half), at(1, outer, half), at(1, inner, half)});
    addFace(mesh, {at(1, inner, -half), at(1, outer, -half), at(0, outer, -half), at(0, inner, -half)});
  }
  return mesh;
}

Mesh gear(int teeth, double inner, double outer, double half) {
  Mesh mesh = ring(0.35 * inner, inner, half);
  for (int i = 0; i < teeth; ++i) {
    const auto at = [&](double k, double radius) {
      const double angle = kTurn * (i + k) / teeth;
      return glm::dvec2(radius * std::cos(angle), -radius * std::sin(angle));
    };
    add(mesh, prism({at(0.1, inner), at(0.3, outer), at(0.5, outer), at(0.7, inner)}, half));
  }
  return mesh;
}

Mesh tube(const std::vector<glm::dvec3>& path, double radius) {
  constexpr int kSides = 18;
  Mesh mesh;
  glm::dvec3 side(0.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const glm::dvec3 tangent = glm::normalize(path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]);
    // The frame is carried along, so that the tube does not twist.
    if (i == 0) side = std::abs(tangent.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    side = glm::normalize(side - glm::dot(side, tangent) * tangent);
    const glm::dvec3 other = glm::cross(tangent, side);
    for (int k = 0; k < kSides; ++k) {
      const double angle = kTurn * k / kSides;
      const glm::dvec3 normal = std::cos(angle) * side + std::sin(angle) * other;
      mesh.positions.emplace_back(path[i] + radius * normal);
      mesh.normals.emplace_back(normal);
    }
    if (i == 0) continue;
    const auto row = static_cast<std::uint32_t>(kSides * (i - 1));
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = row + k, b = row + (k + 1) % kSides;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + kSides, a, b + kSides, a + kSides});
    }
  }
  return mesh;
}

Mesh spring(double radius, double wire, double height, int turns) {
  std::vector<glm::dvec3> path;
  constexpr int kSteps = 18;
  for (int i = 0; i <= turns * kSteps; ++i) {
    const double angle = kTurn * i / kSteps;
    path.emplace_back(radius * std::cos(angle), height * i / (turns * kSteps), radius * std::sin(angle));
  }
  return tube(path, wire);
}

std::vector<glm::dvec3> curve(const std::vector<glm::dvec3>& points, int steps) {
  std::vector<glm::dvec3> out;
  const int last = static_cast<int>(points.size()) - 1;
  const auto at = [&](int i) { return points[static_cast<std::size_t>(glm::clamp(i, 0, last))]; };
  for (int i = 0; i < last; ++i)
    for (int k = 0; k < steps + (i + 1 == last ? 1 : 0); ++k) {
      const double t = static_cast<double>(k) / steps, t2 = t * t, t3 = t2 * t;
      out.push_back(0.5 * (2.0 * at(i) + (at(i + 1) - at(i - 1)) * t +
                           (2.0 * at(i - 1) - 5.0 * at(i) + 4.0 * at(i + 1) - at(i + 2)) * t2 +
                           (3.0 * at(i) - at(i - 1) - 3.0 * at(i + 1) + at(i + 2)) * t3));
    }
  return out;
}

}  // namespace pellucid::samples
