// A glass ball and three turned pieces on a board, which bend what stands behind them. PT17 fig. 19.
#include <cmath>

#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

// A volume: rays that enter it are bent. Thickness in metres.
nlohmann::json solidGlass(const std::string& name, glm::dvec3 colour, double thickness) {
  nlohmann::json material = glass(name, colour, 1.5, 0.0);
  material["doubleSided"] = false;
  material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", thickness}};
  return material;
}

std::vector<glm::dvec2> circle(double radius) {
  std::vector<glm::dvec2> points;
  constexpr int kPoints = 13;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 3.14159265358979 * (i / (kPoints - 1.0) - 0.5);
    points.emplace_back(std::max(radius * std::cos(angle), 0.0), radius * (1.0 + std::sin(angle)));
  }
  return points;
}

// Foot, waist, collar and head, as fractions of the height.
std::vector<glm::dvec2> pawn(double height) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec2 p : {glm::dvec2(0.0, 0.0),
                             {0.26, 0.0},
                             {0.28, 0.08},
                             {0.2, 0.16},
                             {0.12, 0.4},
                             {0.1, 0.58},
                             {0.17, 0.63},
                             {0.1, 0.68},
                             {0.17, 0.82},
                             {0.12, 0.95},
                             {0.0, 1.0}})
    points.emplace_back(p.x * height, p.y * height);
  return points;
}

}  // namespace

Sample ball() {
  Sample sample;
  sample.view.eye = {0.0, 0.34, 1.35};
  sample.view.target = {0.0, 0.13, 0.0};
  sample.view.yfov = 0.42;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.5, 0.9, 0.5));
  studio.sunIrradiance = {3.0, 2.9, 2.6};
  studio.ambient = {0.36, 0.38, 0.42};
  studio.ambientReach = 0.3;
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.02, 0.0}, {2.0, 0.02, 2.0}, 0.0, checker({0.8, 0.74, 0.62}, {0.16, 0.1, 0.06}, 0.09)},
      {ShapeKind::box, {0.0, 0.5, -1.6}, {2.0, 0.5, 0.05}, 0.0, checker({0.65, 0.3, 0.2}, {0.2, 0.35, 0.5}, 0.2)},
      {ShapeKind::cylinder, {-0.19, 0.16, -0.5}, {0.03, 0.16, 0.0}, 0.0, plain({0.8, 0.65, 0.1})},
      // In front of the ball: it must not show inside it.
      {ShapeKind::cylinder, {0.03, 0.07, 0.33}, {0.008, 0.07, 0.0}, 0.0, plain({0.75, 0.1, 0.1})},
  };
  sample.glb.addMesh("ball", lathe(circle(0.13), 6, 64),
                     sample.glb.addMaterial(solidGlass("clear", {0.97, 0.98, 0.98}, 0.2)), {-0.02, 0.001, 0.05});
  const struct {
    const char* name;
    glm::dvec3 colour, place;
  } pieces[] = {{"green piece", {0.45, 0.85, 0.55}, {-0.28, 0.001, 0.02}},
                {"amber piece", {0.95, 0.62, 0.22}, {0.22, 0.001, 0.1}},
                {"blue piece", {0.35, 0.5, 0.95}, {0.33, 0.001, -0.12}}};
  for (const auto& piece : pieces)
    sample.glb.addMesh(piece.name, lathe(pawn(0.24), 6, 48),
                       sample.glb.addMaterial(solidGlass(piece.name, piece.colour, 0.05)), piece.place);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
