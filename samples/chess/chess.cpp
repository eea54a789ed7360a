// Coloured glass pieces on a corner of a board in low sun: coloured shadows that cross. PT17 fig. 19.
#include <cmath>

#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

nlohmann::json solidGlass(const std::string& name, glm::dvec3 colour) {
  nlohmann::json material = glass(name, colour, 1.5, 0.0);
  material["doubleSided"] = false;
  material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.04}};
  return material;
}

// Profiles from the foot up, as fractions of the height.
using Profile = std::vector<glm::dvec2>;
const Profile kPawn = {{0.0, 0.0},   {0.3, 0.0},   {0.32, 0.08}, {0.22, 0.16}, {0.13, 0.42}, {0.11, 0.58},
                       {0.19, 0.63}, {0.11, 0.68}, {0.19, 0.82}, {0.13, 0.95}, {0.0, 1.0}};
const Profile kBishop = {{0.0, 0.0},   {0.23, 0.0},  {0.25, 0.06}, {0.16, 0.13}, {0.09, 0.4}, {0.08, 0.6},
                         {0.15, 0.64}, {0.08, 0.68}, {0.13, 0.8},  {0.07, 0.93}, {0.0, 1.0}};
const Profile kRook = {{0.0, 0.0},  {0.28, 0.0},  {0.3, 0.07}, {0.2, 0.15},  {0.15, 0.6},
                       {0.22, 0.7}, {0.24, 0.98}, {0.17, 1.0}, {0.15, 0.86}, {0.0, 0.84}};

Mesh piece(const Profile& profile, double height) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec2& p : profile) points.push_back(height * p);
  return lathe(points, 5, 48);
}

}  // namespace

Sample chess() {
  constexpr double kSquare = 0.06;
  Sample sample;
  sample.view.eye = {0.16, 0.34, 0.52};
  sample.view.target = {0.0, 0.03, 0.0};
  sample.view.yfov = 0.55;

  Studio& studio = sample.studio;
  studio.sunLayer = true;
  studio.toSun = glm::normalize(glm::dvec3(-0.8, 0.75, -0.45));
  studio.sunIrradiance = {4.2, 3.9, 3.4};
  studio.sunRadius = 0.005;
  studio.ambient = {0.22, 0.24, 0.28};
  studio.ambientReach = 0.2;
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.16, 0.17, 0.2); };
  studio.shapes = {
      {ShapeKind::box,
       {0.0, -0.008, 0.0},
       {0.24, 0.008, 0.24},
       0.0,
       checker({0.82, 0.78, 0.7}, {0.3, 0.24, 0.2}, kSquare)},
      {ShapeKind::box, {0.0, -0.03, 0.0}, {0.26, 0.022, 0.26}, 0.0, plain({0.3, 0.17, 0.09})},
      {ShapeKind::box, {0.0, -0.07, 0.0}, {3.0, 0.02, 3.0}, 0.0, plain({0.42, 0.4, 0.38})},
  };
  const struct {
    const char* name;
    const Profile* profile;
    double height;
    glm::dvec3 colour;
    int file, rank;  // squares from the middle
  } pieces[] = {
      {"red pawn", &kPawn, 0.09, {0.9, 0.12, 0.1}, -2, 1},
      {"amber pawn", &kPawn, 0.09, {0.95, 0.6, 0.1}, -1, 1},
      {"green pawn", &kPawn, 0.09, {0.15, 0.8, 0.3}, 0, 0},
      {"blue pawn", &kPawn, 0.09, {0.15, 0.35, 0.95}, 1, 1},
      {"violet pawn", &kPawn, 0.09, {0.6, 0.2, 0.85}, 2, 0},
      {"clear bishop", &kBishop, 0.15, {0.95, 0.97, 0.97}, -1, -1},
      {"cyan rook", &kRook, 0.11, {0.2, 0.8, 0.85}, -3, -1},
      {"red bishop", &kBishop, 0.15, {0.9, 0.15, 0.12}, 1, -2},
      {"green rook", &kRook, 0.11, {0.25, 0.8, 0.3}, 2, -2},
  };
  for (const auto& each : pieces)
    sample.glb.addMesh(each.name, piece(*each.profile, each.height),
                       sample.glb.addMaterial(solidGlass(each.name, each.colour)),
                       {kSquare * (each.file + 0.5), 0.0005, kSquare * (each.rank + 0.5)});
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
