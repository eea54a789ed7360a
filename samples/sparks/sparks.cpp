// A fire in a ring of stones at dusk: flames and sparks that only add light, and smoke above that hides some of them.
#include <cmath>

#include "samples/generate/hash.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

double random(std::uint32_t i, std::uint32_t what) {
  return unit(hash(i, what, 3141));
}

glm::dvec3 aside(double angle, double radius) {
  return {radius * std::cos(angle), 0.0, radius * std::sin(angle)};
}

// A tongue of fire: wide at the logs, narrow at its tip, turning as it rises.
//   reach  part of the fire's height, [0,1]
Points flames(std::uint32_t first, std::uint32_t count, double reach, double radius, double alpha) {
  Points points;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const double up = std::pow(random(i, 0), 1.3);
    const double wide = 0.26 * std::pow(1.0 - up, 0.6) * std::sqrt(random(i, 1));
    const double turn = 2.0 * M_PI * random(i, 2) + 2.5 * up;
    const glm::dvec3 sway = 0.07 * up * glm::dvec3(std::sin(7.0 * up), 0.0, std::cos(5.0 * up));
    points.positions.emplace_back(glm::dvec3(0.0, 0.12 + 1.05 * reach * up, 0.0) + aside(turn, wide) + sway);
    points.radii.push_back(static_cast<float>(radius * (1.15 - 0.8 * up)));
    points.colours.emplace_back(1.0f, 1.0f, 1.0f, static_cast<float>(alpha * (1.0 - 0.7 * up)));
  }
  return points;
}

Points sparks(std::uint32_t count) {
  Points points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double up = random(i, 20), turn = 2.0 * M_PI * random(i, 21) + 4.0 * up;
    const double wide = (0.12 + 0.75 * up) * std::sqrt(random(i, 22));
    points.positions.emplace_back(glm::dvec3(0.15 * up, 0.35 + 2.0 * up, 0.0) + aside(turn, wide));
    points.radii.push_back(static_cast<float>(0.0035 + 0.006 * random(i, 23)));
    points.colours.emplace_back(1.0f, 1.0f, 1.0f, static_cast<float>(0.3 + 0.7 * random(i, 24)));
  }
  return points;
}

Points smokeAbove(std::uint32_t count) {
  Points points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double up = random(i, 30), turn = 2.0 * M_PI * random(i, 31) + 3.0 * up;
    const double wide = (0.1 + 0.4 * up) * std::sqrt(random(i, 32));
    points.positions.emplace_back(glm::dvec3(0.35 * up * up, 1.0 + 1.3 * up, 0.0) + aside(turn, wide));
    points.radii.push_back(static_cast<float>(0.12 + 0.16 * up));
    points.colours.emplace_back(1.0f, 1.0f, 1.0f, static_cast<float>(0.4 * (1.0 - 0.6 * up)));
  }
  return points;
}

// Emits and reflects nothing; `additive` leaves what is behind as bright as it was.
int light(Glb& glb, const char* name, glm::dvec3 colour, double strength) {
  return glb.addMaterial(
      {{"name", name},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.0, 0.0, 0.0, 1.0}}, {"metallicFactor", 0.0}}},
       {"emissiveFactor", list(colour)},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}},
       {"extras", {{"pellucid", {{"additive", true}}}}}});
}

}  // namespace

Sample fire() {
  Sample sample;
  sample.view.eye = {0.0, 1.35, 4.6};
  sample.view.target = {0.05, 0.95, 0.0};
  sample.view.yfov = 0.55;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.8, 0.35, -0.6));
  studio.sunIrradiance = {0.35, 0.3, 0.42};
  studio.sunLayer = true;
  studio.ambient = {0.03, 0.04, 0.07};
  studio.sky = [](glm::dvec3 fromEye) {
    const double up = std::max(fromEye.y, 0.0);
    return glm::mix(glm::dvec3(0.16, 0.1, 0.1), glm::dvec3(0.02, 0.03, 0.07), std::min(3.0 * up, 1.0));
  };
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {12.0, 0.05, 12.0}, 0.0, checker({0.3, 0.27, 0.22}, {0.24, 0.21, 0.18}, 0.6)},
      {ShapeKind::box, {0.05, 0.06, 0.06}, {0.38, 0.05, 0.05}, 0.5, plain({0.24, 0.15, 0.09})},
      {ShapeKind::box, {-0.03, 0.07, -0.03}, {0.36, 0.05, 0.05}, 2.1, plain({0.2, 0.13, 0.08})},
      {ShapeKind::cylinder, {1.15, 0.4, -0.5}, {0.12, 0.4, 0.0}, 0.0, plain({0.3, 0.2, 0.14})},
  };
  for (int i = 0; i < 9; ++i)
    studio.shapes.push_back({ShapeKind::sphere,
                             glm::dvec3(0.0, 0.06, 0.0) + aside(2.0 * M_PI * i / 9.0, 0.55),
                             {0.1 + 0.03 * random(static_cast<std::uint32_t>(i), 40), 0.0, 0.0},
                             0.0,
                             plain({0.32, 0.31, 0.3})});
  Glb& glb = sample.glb;
  glb.addPoints("flame.outer", flames(0, 900, 1.0, 0.075, 0.16), light(glb, "flame.outer", {1.0, 0.22, 0.03}, 0.8));
  glb.addPoints("flame.core", flames(10000, 700, 0.6, 0.055, 0.2), light(glb, "flame.core", {1.0, 0.55, 0.16}, 0.75));
  glb.addPoints("sparks", sparks(420), light(glb, "sparks", {1.0, 0.45, 0.12}, 9.0));
  const int smoke = glb.addMaterial(
      {{"name", "smoke"},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.55, 0.55, 0.58, 1.0}}, {"metallicFactor", 0.0}}},
       {"extras", {{"pellucid", {{"phase", 0.3}}}}}});
  glb.addPoints("smoke", smokeAbove(260), smoke);
  glb.addCamera("cam", sample.view);
  glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
