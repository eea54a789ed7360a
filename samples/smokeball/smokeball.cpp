// A ball of smoke made of particles over a checkered ground, with a cube partly in it. PT17 figs. 15-17.
#include <cmath>

#include "samples/generate/hash.h"
#include "samples/generate/sample.h"
#include "samples/generate/solids.h"

namespace pellucid::samples {
namespace {

// Evenly in a ball, the larger ones towards its middle.
Points smokeOf(std::uint32_t count, glm::dvec3 centre, double radius, double size) {
  Points points;
  for (std::uint32_t i = 0; points.positions.size() < count; ++i) {
    const auto random = [&](std::uint32_t what) { return unit(hash(i, what, 1517)); };
    const glm::dvec3 at(2.0 * random(0) - 1.0, 2.0 * random(1) - 1.0, 2.0 * random(2) - 1.0);
    const double far = glm::length(at);
    if (far > 1.0) continue;
    points.positions.emplace_back(centre + radius * at);
    points.radii.push_back(static_cast<float>(size * (0.7 + 0.6 * random(3)) * (1.2 - 0.5 * far)));
    points.colours.emplace_back(1.0f, 1.0f, 1.0f, static_cast<float>(0.7 + 0.3 * random(4)));
  }
  return points;
}

}  // namespace

Sample smokeBall(std::uint32_t particles) {
  Sample sample;
  sample.view.eye = {0.6, 2.2, 5.6};
  sample.view.target = {0.1, 0.75, 0.0};
  sample.view.yfov = 0.5;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.75, 0.9, 0.35));
  studio.sunIrradiance = {8.0, 7.5, 6.8};
  studio.sunLayer = true;
  studio.ambient = {0.08, 0.1, 0.13};
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.08, 0.1, 0.13); };
  studio.shapes = {
      {ShapeKind::box,
       {0.0, -0.05, 0.0},
       {12.0, 0.05, 12.0},
       0.0,
       checker({0.34, 0.33, 0.31}, {0.24, 0.24, 0.23}, 0.5)},
      {ShapeKind::box, {-0.75, 1.35, 0.3}, {0.22, 0.22, 0.22}, 0.4, plain({0.7, 0.25, 0.12})},
  };
  const double size = 0.2 * std::cbrt(1000.0 / particles);
  // As much is seen through few large particles as through many small ones: coverage times discs' area is one number.
  const double depth = 0.28 * std::cbrt(particles / 1000.0) * std::pow(1000.0 / particles, 2.0 / 3.0);
  const int material = sample.glb.addMaterial(
      {{"name", "smoke"},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.92, 0.92, 0.95, 1.0 - std::exp(-depth)}}, {"metallicFactor", 0.0}}},
       {"extras", {{"pellucid", {{"phase", 0.2}}}}}});
  sample.glb.addPoints("smoke", smokeOf(particles, {0.1, 0.95, 0.0}, 0.78, size), material);
  addSolids(sample.glb, studio.shapes);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

Sample smokeball() {
  return smokeBall(1000);
}

}  // namespace pellucid::samples
