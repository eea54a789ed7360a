// Five coloured bottles that overlap on a table in the sun. PT17 fig. 12.
#include <cmath>

#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

struct Bottle {
  const char* name;
  glm::dvec3 colour;  // what one wall lets through, [0,1] linear
  glm::dvec2 place;   // x, z on the table, metres
  double radius, height;
};
const Bottle kBottles[] = {{"amber", {0.92, 0.52, 0.12}, {-0.125, -0.01}, 0.042, 0.25},
                           {"green", {0.22, 0.72, 0.32}, {-0.055, 0.085}, 0.036, 0.21},
                           {"blue", {0.22, 0.42, 0.92}, {0.02, -0.035}, 0.044, 0.28},
                           {"rose", {0.94, 0.32, 0.42}, {0.095, 0.06}, 0.038, 0.22},
                           {"clear", {0.93, 0.96, 0.94}, {0.15, -0.05}, 0.04, 0.26}};

// Foot, body, shoulder, neck and lip, as fractions of the radius and the height.
std::vector<glm::dvec2> profile(const Bottle& bottle) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec2 p : {glm::dvec2(0.0, 0.012),
                             {0.55, 0.01},
                             {0.85, 0.0},
                             {0.97, 0.02},
                             {1.0, 0.06},
                             {1.0, 0.3},
                             {1.0, 0.52},
                             {0.93, 0.62},
                             {0.62, 0.72},
                             {0.38, 0.8},
                             {0.33, 0.88},
                             {0.33, 0.98}})
    points.emplace_back(p.x * bottle.radius, p.y * bottle.height + 1e-4);
  return points;
}

glm::dvec3 wood(glm::dvec3 p) {
  const double grain = 0.5 + 0.5 * std::sin(60.0 * p.z + 3.0 * std::sin(7.0 * p.x) + 1.3 * std::sin(23.0 * p.x));
  const double plank = std::abs(std::remainder(p.z, 0.16)) < 0.0016 ? 0.35 : 1.0;
  return plank * glm::mix(glm::dvec3(0.36, 0.2, 0.1), glm::dvec3(0.5, 0.31, 0.17), grain);
}

}  // namespace

Sample bottles() {
  Sample sample;
  sample.view.eye = {0.0, 0.3, 0.95};
  sample.view.target = {0.01, 0.115, 0.0};
  sample.view.yfov = 0.42;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.6, 0.9, 0.55));
  studio.sunIrradiance = {3.4, 3.2, 2.8};
  studio.ambient = {0.34, 0.37, 0.42};
  studio.ambientReach = 0.25;
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.02, 0.0}, {1.2, 0.02, 0.6}, 0.0, wood},
      {ShapeKind::box, {0.0, 0.4, -0.65}, {1.6, 0.9, 0.05}, 0.0, plain({0.62, 0.6, 0.56})},
      {ShapeKind::box,
       {-0.03, 0.05, -0.24},
       {0.05, 0.05, 0.05},
       0.5,
       checker({0.85, 0.8, 0.7}, {0.12, 0.13, 0.15}, 0.025)},
      {ShapeKind::sphere, {0.16, 0.045, -0.2}, glm::dvec3(0.045), 0.0, plain({0.7, 0.25, 0.12})},
      {ShapeKind::sphere, {-0.2, 0.03, 0.1}, glm::dvec3(0.03), 0.0, plain({0.8, 0.78, 0.72})},
  };

  // Shells of two millimetres: light meets the near and the far wall of each bottle, and `colour` is left of it by
  // each.
  constexpr double kWall = 0.002;
  for (const Bottle& bottle : kBottles) {
    nlohmann::json material = glass(bottle.name, glm::dvec3(1.0), 1.45, 0.12);
    material["extensions"]["KHR_materials_volume"] = {
        {"thicknessFactor", kWall}, {"attenuationDistance", kWall}, {"attenuationColor", list(bottle.colour)}};
    const int index = sample.glb.addMaterial(material);
    const glm::dvec3 foot(bottle.place.x, 0.0, bottle.place.y);
    sample.glb.addMesh(bottle.name, lathe(profile(bottle), 4, 48), index, foot);
    studio.shapes.push_back({ShapeKind::cylinder,
                             foot + glm::dvec3(0.0, 0.985 * bottle.height, 0.0),
                             {0.4 * bottle.radius, 0.035 * bottle.height, 0.0},
                             0.0,
                             plain({0.82, 0.82, 0.8})});
  }
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
