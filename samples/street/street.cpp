// A foggy street at dusk: banks of fog as large soft cards, marked for low resolution, that hide and blur what lies
// behind them; halos of additive light around the lamps. PT17 fig. 1, right.
#include <algorithm>
#include <cmath>

#include "samples/generate/hash.h"
#include "samples/generate/puffs.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr int kHouses = 7, kLamps = 5, kBanks = 9, kCardsInBank = 10;
constexpr double kHalfStreet = 4.2, kLampX = 3.2, kLampHeight = 3.4;

double lampZ(int i) {
  return -2.0 - 6.0 * i;
}

// Rows of lit and dark windows in plaster.
Albedo facade(glm::dvec3 plaster, std::uint32_t seed) {
  return [plaster, seed](glm::dvec3 p) {
    const glm::dvec3 cell(p.x / 1.6, p.y / 1.5, p.z / 1.6);
    const glm::dvec3 inside = cell - glm::floor(cell);
    const bool window = inside.y > 0.3 && inside.y < 0.8 && inside.z > 0.3 && inside.z < 0.7;
    if (!window) return plaster;
    const auto number = static_cast<std::uint32_t>(static_cast<int>(std::floor(cell.y)) * 97 +
                                                   static_cast<int>(std::floor(cell.z)) + 5000);
    return unit(hash(number, seed)) > 0.6 ? glm::dvec3(0.95, 0.7, 0.3) : glm::dvec3(0.05, 0.06, 0.08);
  };
}

void addHouses(std::vector<Shape>& shapes) {
  for (int side : {-1, 1})
    for (int i = 0; i < kHouses; ++i) {
      const auto seed = static_cast<std::uint32_t>(2 * i + (side + 1) / 2);
      const double height = 2.6 + 1.6 * unit(hash(seed, 3)), tint = unit(hash(seed, 4));
      const glm::dvec3 plaster = glm::mix(glm::dvec3(0.5, 0.3, 0.22), glm::dvec3(0.45, 0.45, 0.42), tint);
      shapes.push_back({ShapeKind::box,
                        {side * (kHalfStreet + 2.0), height, 1.5 - 6.0 * i},
                        {2.0, height, 2.9},
                        0.0,
                        facade(plaster, seed)});
    }
}

}  // namespace

Sample street() {
  Sample sample;
  sample.view.eye = {-0.6, 1.7, 6.0};
  sample.view.target = {0.2, 1.9, -10.0};
  sample.view.yfov = 0.75;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.7, 0.5, 0.2));
  studio.sunIrradiance = {0.5, 0.42, 0.4};
  studio.ambient = {0.16, 0.19, 0.26};
  studio.sky = [](glm::dvec3 fromEye) {
    return glm::mix(glm::dvec3(0.55, 0.42, 0.36), glm::dvec3(0.12, 0.17, 0.3), std::clamp(2.0 * fromEye.y, 0.0, 1.0));
  };
  studio.shapes = {{ShapeKind::box,
                    {0.0, -0.05, -20.0},
                    {40.0, 0.05, 40.0},
                    0.0,
                    checker({0.2, 0.2, 0.21}, {0.16, 0.16, 0.17}, 0.8)}};
  addHouses(studio.shapes);
  std::vector<PuffCard> halos;
  for (int i = 0; i < kLamps; ++i)
    for (int side : {-1, 1}) {
      const double x = side * kLampX, z = lampZ(i);
      studio.shapes.push_back({ShapeKind::cylinder,
                               {x, 0.5 * kLampHeight, z},
                               {0.06, 0.5 * kLampHeight, 0.0},
                               0.0,
                               plain({0.05, 0.05, 0.06})});
      studio.shapes.push_back({ShapeKind::sphere, {x, kLampHeight, z}, {0.16, 0.0, 0.0}, 0.0, plain({1.0, 0.95, 0.8})});
      halos.push_back({{x, kLampHeight, z + 0.3}, 1.7, {0.5, 0.34, 0.15}});
    }

  std::vector<PuffCard> fog;
  for (std::uint32_t bank = 0; bank < kBanks; ++bank)
    for (std::uint32_t i = 0; i < kCardsInBank; ++i) {
      const auto random = [&](std::uint32_t what) { return unit(hash(bank * kCardsInBank + i, what, 41)); };
      const double z = -2.5 - 3.4 * bank - 1.5 * random(0), low = random(1) * random(1);
      fog.push_back({{(random(2) - 0.5) * 13.0, 1.2 + 3.0 * low, z},
                     4.5 + 2.5 * random(3),
                     glm::mix(glm::dvec3(0.42, 0.4, 0.4), glm::dvec3(0.28, 0.31, 0.38), low)});
    }
  addCloud(sample.glb, {"fog", 41, 0.38, {{"lowResolution", true}, {"collimation", 0.85}}}, fog);
  addCloud(sample.glb, {"halo", 77, 0.6, {{"additive", true}}}, halos);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
