// Smoke cards around a crate in a yard, seen through a window of tinted panes.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/files.h"
#include "samples/generate/hash.h"
#include "samples/generate/puffs.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr int kPuffs = 2, kCards = 56;

// Cards that face the window, each turned in its plane, their light baked into vertex colours: warmer towards the sun.
void addSmoke(Glb& glb, glm::dvec3 centre, glm::dvec3 reach, glm::dvec3 toSun) {
  int materials[kPuffs];
  for (int i = 0; i < kPuffs; ++i) {
    const auto seed = static_cast<std::uint32_t>(i);
    const std::string name = "puff " + std::to_string(i);
    const int texture = glb.addTexture(name, encodePng(puff(seed)));
    materials[i] = glb.addMaterial({{"name", name},
                                    {"alphaMode", "BLEND"},
                                    {"doubleSided", true},
                                    {"pbrMetallicRoughness",
                                     {{"baseColorFactor", {1.0, 1.0, 1.0, 0.5}},
                                      {"baseColorTexture", {{"index", texture}}},
                                      {"metallicFactor", 0.0}}},
                                    {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
  }
  Mesh cards[kPuffs];
  for (std::uint32_t i = 0; i < kCards; ++i) {
    const auto random = [&](std::uint32_t what) { return unit(hash(i, what, 77)); };
    const double height = random(0), spin = 2.0 * glm::pi<double>() * random(1),
                 angle = 2.0 * glm::pi<double>() * random(2);
    const double radius = std::sqrt(random(3)) * (0.55 + 0.45 * height);
    const glm::dvec3 offset(radius * std::cos(angle), 2.0 * height - 1.0, radius * std::sin(angle));
    const glm::dvec3 middle = centre + reach * offset + glm::dvec3(0.35 * height, 0.0, 0.0);
    const double edge = 0.55 + 0.65 * random(4);
    const glm::dvec3 right = edge * glm::dvec3(std::cos(spin), std::sin(spin), 0.0);
    const glm::dvec3 up(-right.y, right.x, 0.0);
    Mesh& mesh = cards[i % kPuffs];
    addQuad(mesh, middle - 0.5 * (right + up), right, up);
    const double lit = std::clamp(0.5 + 0.45 * glm::dot(glm::normalize(offset + 1e-3), toSun), 0.0, 1.0);
    const glm::vec4 colour(glm::mix(glm::dvec3(0.1, 0.11, 0.13), glm::dvec3(0.75, 0.68, 0.6), lit), 1.0);
    mesh.colours.insert(mesh.colours.end(), 4, colour);
  }
  for (int i = 0; i < kPuffs; ++i) glb.addMesh("smoke " + std::to_string(i), cards[i], materials[i]);
}

// A room's wall at z = 2 with a hole, and a frame with a mullion in it.
void addWindow(std::vector<Shape>& shapes) {
  const Albedo plaster = plain({0.5, 0.47, 0.42}), paint = plain({0.75, 0.74, 0.7});
  const auto box = [&](glm::dvec3 low, glm::dvec3 high, const Albedo& albedo) {
    shapes.push_back({ShapeKind::box, 0.5 * (low + high), 0.5 * (high - low), 0.0, albedo});
  };
  box({-4.0, 0.0, 1.9}, {-1.1, 3.5, 2.1}, plaster);
  box({1.1, 0.0, 1.9}, {4.0, 3.5, 2.1}, plaster);
  box({-1.1, 0.0, 1.9}, {1.1, 0.7, 2.1}, plaster);
  box({-1.1, 2.2, 1.9}, {1.1, 3.5, 2.1}, plaster);
  for (const double x : {-1.1, -0.035, 1.03}) box({x, 0.7, 1.95}, {x + 0.07, 2.2, 2.05}, paint);
  for (const double y : {0.7, 2.13}) box({-1.1, y, 1.95}, {1.1, y + 0.07, 2.05}, paint);
  box({-1.2, 0.66, 2.1}, {1.2, 0.7, 2.25}, paint);
}

void addPane(Glb& glb, const char* name, glm::dvec3 colour, double left) {
  Mesh pane;
  addQuad(pane, {left, 0.72, 2.0}, {1.1, 0.0, 0.0}, {0.0, 1.46, 0.0});
  glb.addMesh(name, pane, glb.addMaterial(glass(name, colour, 1.5, 0.03)));
}

}  // namespace

Sample smoke() {
  Sample sample;
  sample.view.eye = {0.15, 1.5, 4.9};
  sample.view.target = {0.0, 1.42, 2.0};

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.6, 0.8, -0.3));
  studio.sunIrradiance = {3.4, 3.1, 2.6};
  studio.ambient = {0.3, 0.35, 0.42};
  studio.sky = [](glm::dvec3 fromEye) {
    return glm::mix(glm::dvec3(0.75, 0.8, 0.85), glm::dvec3(0.25, 0.42, 0.75), std::clamp(2.5 * fromEye.y, 0.0, 1.0));
  };
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {12.0, 0.05, 12.0}, 0.0, checker({0.42, 0.4, 0.37}, {0.32, 0.3, 0.28}, 0.6)},
      {ShapeKind::box,
       {0.1, 0.45, -1.0},
       {0.45, 0.45, 0.45},
       0.5,
       checker({0.6, 0.36, 0.14}, {0.45, 0.25, 0.09}, 0.15)},
      {ShapeKind::box, {0.0, 0.7, -6.0}, {12.0, 0.7, 0.15}, 0.0, checker({0.5, 0.2, 0.14}, {0.42, 0.16, 0.11}, 0.35)},
      {ShapeKind::cylinder, {-1.5, 1.5, -2.5}, {0.09, 1.5, 0.0}, 0.0, plain({0.3, 0.32, 0.33})},
  };
  addWindow(studio.shapes);

  addSmoke(sample.glb, {0.0, 1.05, -1.0}, {1.1, 0.85, 0.9}, studio.toSun);
  addPane(sample.glb, "green pane", {0.7, 0.93, 0.8}, -1.1);
  addPane(sample.glb, "amber pane", {0.97, 0.8, 0.5}, 0.0);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
