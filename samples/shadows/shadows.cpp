// A cloud and four glass balls of rising index over a floor, which show their shadows. PT17 figs. 9 and 10.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/files.h"
#include "samples/generate/hash.h"
#include "samples/generate/puffs.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr std::uint32_t kCards = 160;

// Cards that lean back, so that the eye and the sun both see their faces.
const glm::dvec3 kAcross(1.0, 0.0, 0.0),
    kAlong(0.0, glm::one_over_root_two<double>(), -glm::one_over_root_two<double>());

// Lit cards with one normal for all: what form the cloud has comes from its own shadow.
void addLitCloud(Glb& glb, glm::dvec3 centre, glm::dvec3 reach) {
  Mesh cards;
  for (std::uint32_t i = 0; i < kCards; ++i) {
    const auto random = [&](std::uint32_t what) { return unit(hash(i, what, 19)); };
    const double up = 2.0 * random(0) - 1.0, angle = 2.0 * glm::pi<double>() * random(1);
    const double radius = std::cbrt(random(2)), ring = std::sqrt(1.0 - up * up);
    const glm::dvec3 middle = centre + reach * radius * glm::dvec3(ring * std::cos(angle), up, ring * std::sin(angle));
    const double edge = 0.22 + 0.16 * random(3), spin = 2.0 * glm::pi<double>() * random(4);
    const glm::dvec3 right = edge * (std::cos(spin) * kAcross + std::sin(spin) * kAlong);
    const glm::dvec3 top = edge * (std::cos(spin) * kAlong - std::sin(spin) * kAcross);
    addQuad(cards, middle - 0.5 * (right + top), right, top);
  }
  const int texture = glb.addTexture("puff", encodePng(puff(5)));
  glb.addMesh("cloud", cards,
              glb.addMaterial({{"name", "cloud"},
                               {"alphaMode", "BLEND"},
                               {"doubleSided", true},
                               {"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.78, 0.79, 0.82, 0.5}},
                                 {"baseColorTexture", {{"index", texture}}},
                                 {"metallicFactor", 0.0},
                                 {"roughnessFactor", 1.0}}},
                               {"extensions", {{"KHR_materials_ior", {{"ior", 1.0}}}}}}));
}

std::vector<glm::dvec2> circle(double radius) {
  std::vector<glm::dvec2> points;
  constexpr int kPoints = 17;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = glm::pi<double>() * (i / (kPoints - 1.0) - 0.5);
    points.emplace_back(std::max(radius * std::cos(angle), 0.0), radius * std::sin(angle));
  }
  return points;
}

void addBall(Glb& glb, const std::string& name, glm::dvec3 colour, double ior, glm::dvec3 centre) {
  nlohmann::json material = glass(name, colour, ior, 0.0);
  material["doubleSided"] = false;
  material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.4}};
  glb.addMesh(name, lathe(circle(0.27), 6, 96), glb.addMaterial(material), centre);
}

}  // namespace

Sample shadows() {
  Sample sample;
  sample.view.eye = {0.25, 1.75, 4.4};
  sample.view.target = {0.15, 0.42, 0.0};
  sample.view.yfov = 0.5;

  Studio& studio = sample.studio;
  studio.sunLayer = true;
  studio.toSun = glm::normalize(glm::dvec3(-0.45, 1.0, 0.25));
  studio.sunIrradiance = {3.2, 3.1, 2.9};
  studio.sunRadius = 0.005;
  studio.ambient = {0.2, 0.22, 0.26};
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.55, 0.62, 0.72); };
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {6.0, 0.05, 6.0}, 0.0, checker({0.66, 0.65, 0.62}, {0.58, 0.57, 0.55}, 0.5)},
      {ShapeKind::box, {-1.95, 0.18, 0.35}, {0.18, 0.18, 0.18}, 0.4, plain({0.7, 0.3, 0.15})},
  };
  addLitCloud(sample.glb, {-1.35, 0.95, -0.1}, {0.42, 0.3, 0.3});
  addBall(sample.glb, "index 1.0", glm::dvec3(0.6), 1.0, {-0.45, 0.62, 0.0});
  addBall(sample.glb, "index 1.3", glm::dvec3(0.6), 1.3, {0.3, 0.62, 0.0});
  addBall(sample.glb, "index 1.5", glm::dvec3(0.6), 1.5, {1.05, 0.62, 0.0});
  addBall(sample.glb, "amber", {0.9, 0.5, 0.12}, 1.5, {1.8, 0.62, 0.0});
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
