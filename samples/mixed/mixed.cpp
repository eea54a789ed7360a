// Glass at full resolution among smoke at low resolution. PT17 fig. 23.
#include <algorithm>
#include <cmath>

#include "samples/generate/hash.h"
#include "samples/generate/puffs.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr std::uint32_t kCards = 64;

nlohmann::json thinGlass(const std::string& name, glm::dvec3 colour) {
  return glass(name, colour, 1.5, 0.0);
}

std::vector<glm::dvec2> goblet() {
  return {{0.0, 0.0},   {0.2, 0.0},  {0.2, 0.02},  {0.04, 0.05}, {0.03, 0.3},
          {0.06, 0.36}, {0.2, 0.46}, {0.25, 0.62}, {0.22, 0.82}, {0.2, 0.9}};
}

}  // namespace

Sample mixed() {
  Sample sample;
  sample.view.eye = {0.0, 0.75, 3.2};
  sample.view.target = {0.0, 0.5, 0.0};
  sample.view.yfov = 0.55;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.5, 0.8, 0.5));
  studio.sunIrradiance = {2.8, 2.6, 2.3};
  studio.ambient = {0.3, 0.34, 0.4};
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {4.0, 0.05, 4.0}, 0.0, checker({0.46, 0.42, 0.36}, {0.26, 0.24, 0.21}, 0.3)},
      {ShapeKind::box, {0.0, 1.2, -2.4}, {4.0, 1.2, 0.1}, 0.0, checker({0.36, 0.18, 0.14}, {0.3, 0.14, 0.11}, 0.4)},
      {ShapeKind::box, {-0.75, 0.4, -0.5}, {0.22, 0.4, 0.22}, 0.4, checker({0.2, 0.45, 0.6}, {0.12, 0.3, 0.42}, 0.11)},
      {ShapeKind::cylinder, {0.8, 0.7, -0.25}, {0.02, 0.7, 0.0}, 0.0, plain({0.1, 0.1, 0.1})},
      {ShapeKind::cylinder, {0.95, 0.7, -0.6}, {0.05, 0.7, 0.0}, 0.0, plain({0.75, 0.6, 0.2})},
      {ShapeKind::sphere, {0.05, 0.22, -0.9}, {0.22, 0.0, 0.0}, 0.0, plain({0.75, 0.25, 0.12})},
  };
  const struct {
    const char* name;
    glm::dvec3 colour, place;
  } glasses[] = {{"clear goblet", {0.93, 0.96, 0.95}, {-0.3, 0.001, 0.25}},
                 {"green goblet", {0.45, 0.85, 0.55}, {0.3, 0.001, 0.1}},
                 {"red goblet", {0.9, 0.3, 0.25}, {0.05, 0.001, -0.35}}};
  for (const auto& each : glasses)
    sample.glb.addMesh(each.name, lathe(goblet(), 6, 48), sample.glb.addMaterial(thinGlass(each.name, each.colour)),
                       each.place);

  std::vector<PuffCard> smoke;
  for (std::uint32_t i = 0; i < kCards; ++i) {
    const auto random = [&](std::uint32_t what) { return unit(hash(i, what, 23)); };
    const double height = random(0) * random(0);
    const glm::dvec3 middle((random(1) - 0.5) * 2.6, 0.1 + 1.0 * height, -1.5 + 2.1 * random(2));
    smoke.push_back(
        {middle, 0.6 + 0.7 * random(3), glm::mix(glm::dvec3(0.62, 0.6, 0.58), glm::dvec3(0.9, 0.87, 0.82), height)});
  }
  addCloud(sample.glb, {"smoke", 23, 0.45, {{"lowResolution", true}}}, smoke);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
