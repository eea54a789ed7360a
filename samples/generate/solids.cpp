#include "samples/generate/solids.h"

#include <cmath>
#include <string>

namespace pellucid::samples {
namespace {

// Yaw is about +y, as the studio turns its boxes.
Mesh boxMesh(const Shape& shape) {
  const double c = std::cos(shape.yaw), s = std::sin(shape.yaw);
  const glm::dmat3 turn(glm::dvec3(c, 0.0, -s), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(s, 0.0, c));
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 normal(0.0), right(0.0), up(0.0);
      normal[axis] = side;
      right[(axis + 1) % 3] = side;
      up[(axis + 2) % 3] = 1.0;
      right *= shape.half;
      up *= shape.half;
      addQuad(mesh, shape.centre + turn * (normal * shape.half - right - up), turn * (2.0 * right), turn * (2.0 * up));
    }
  return mesh;
}

Mesh sphereMesh(const Shape& shape) {
  constexpr int kSteps = 16;
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 3.141592653589793 * (static_cast<double>(i) / kSteps - 0.5);
    profile.emplace_back(std::max(shape.half.x * std::cos(angle), 0.0), shape.half.x * std::sin(angle));
  }
  Mesh mesh = lathe(profile, 2, 48);
  for (glm::vec3& position : mesh.positions) position += glm::vec3(shape.centre);
  return mesh;
}

}  // namespace

void addSolids(Glb& glb, const std::vector<Shape>& shapes) {
  int number = 0;
  for (const Shape& shape : shapes) {
    if (shape.kind == ShapeKind::cylinder) continue;
    const std::string name = "solid " + std::to_string(number++);
    const glm::dvec3 colour = shape.albedo(shape.centre);
    const int material = glb.addMaterial({{"name", name},
                                          {"doubleSided", true},
                                          {"pbrMetallicRoughness",
                                           {{"baseColorFactor", {colour.r, colour.g, colour.b, 1.0}},
                                            {"metallicFactor", 0.0},
                                            {"roughnessFactor", 1.0}}}});
    glb.addMesh(name, shape.kind == ShapeKind::box ? boxMesh(shape) : sphereMesh(shape), material);
  }
}

}  // namespace pellucid::samples
