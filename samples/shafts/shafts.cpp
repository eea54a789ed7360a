// A dusty room: the sun through a window onto a plant and a glass. Use it with fog. PT17 figs. 13-15 and 25.
#include "samples/foliage/plants.h"
#include "samples/generate/files.h"
#include "samples/generate/sample.h"
#include "samples/generate/solids.h"

namespace pellucid::samples {
namespace {

// A left wall at x = -2 with a hole, cut in six by bars.
void addWindow(std::vector<Shape>& shapes) {
  const Albedo plaster = plain({0.5, 0.46, 0.4}), paint = plain({0.6, 0.58, 0.55});
  const auto box = [&](glm::dvec3 low, glm::dvec3 high, const Albedo& albedo) {
    shapes.push_back({ShapeKind::box, 0.5 * (low + high), 0.5 * (high - low), 0.0, albedo});
  };
  box({-2.2, 0.0, -3.0}, {-2.0, 3.0, -1.9}, plaster);
  box({-2.2, 0.0, -0.3}, {-2.0, 3.0, 3.0}, plaster);
  box({-2.2, 0.0, -1.9}, {-2.0, 1.0, -0.3}, plaster);
  box({-2.2, 2.5, -1.9}, {-2.0, 3.0, -0.3}, plaster);
  for (const double z : {-1.4, -0.87}) box({-2.13, 1.0, z}, {-2.05, 2.5, z + 0.07}, paint);
  box({-2.13, 1.72, -1.9}, {-2.05, 1.79, -0.3}, paint);
  box({-2.2, 3.0, -3.2}, {2.6, 3.2, 3.0}, plaster);   // ceiling
  box({-2.2, 0.0, -3.2}, {2.6, 3.0, -3.0}, plaster);  // back
  box({2.4, 0.0, -3.0}, {2.6, 3.0, 3.0}, plaster);    // right
}

}  // namespace

Sample shafts() {
  Sample sample;
  sample.view.eye = {0.55, 1.35, 3.6};
  sample.view.target = {-0.05, 1.05, -1.2};
  sample.view.yfov = 0.62;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-1.0, 0.62, -0.12));
  studio.sunIrradiance = {14.0, 12.6, 10.4};
  studio.ambient = {0.05, 0.055, 0.065};
  studio.ambientReach = 0.5;
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.9, 1.0, 1.15); };
  studio.shapes = {
      {ShapeKind::box, {0.2, -0.05, 0.0}, {2.4, 0.05, 3.2}, 0.0, checker({0.36, 0.26, 0.18}, {0.3, 0.21, 0.14}, 0.4)},
      {ShapeKind::box, {0.35, 0.3, -1.1}, {0.7, 0.3, 0.4}, 0.0, plain({0.42, 0.27, 0.16})},
      {ShapeKind::box, {0.05, 0.7, -1.15}, {0.13, 0.1, 0.13}, 0.3, plain({0.55, 0.28, 0.2})},
  };
  addWindow(studio.shapes);

  Glb& glb = sample.glb;
  const int leaf =
      glb.addMaterial({{"name", "leaf"},
                       {"doubleSided", true},
                       {"alphaMode", "MASK"},
                       {"alphaCutoff", 0.5},
                       {"pbrMetallicRoughness",
                        {{"baseColorTexture", {{"index", glb.addTexture("leaf", encodePng(leafMask(128)))}}},
                         {"metallicFactor", 0.0},
                         {"roughnessFactor", 0.9}}}});
  glb.addMesh("plant", meshOf(crown({0.05, 1.12, -1.15}, 0.34, 220, 0.15, 11)), leaf);
  nlohmann::json green = glass("vase", glm::dvec3(1.0), 1.45, 0.08);
  green["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 0.004}, {"attenuationDistance", 0.004}, {"attenuationColor", {0.35, 0.8, 0.45}}};
  const std::vector<glm::dvec2> profile = {{0.0, 0.02}, {0.09, 0.01}, {0.13, 0.06}, {0.14, 0.2},
                                           {0.1, 0.34}, {0.05, 0.42}, {0.05, 0.5},  {0.07, 0.54}};
  glb.addMesh("vase", lathe(profile, 4, 48), glb.addMaterial(green), {0.62, 0.6, -1.0});
  glb.addMesh(
      "pane",
      [] {
        Mesh pane;
        addQuad(pane, {-2.1, 1.0, -0.3}, {0.0, 0.0, -1.6}, {0.0, 1.5, 0.0});
        return pane;
      }(),
      glb.addMaterial(glass("pane", {0.96, 0.97, 0.96}, 1.0, 0.0)));
  addSolids(glb, studio.shapes);
  glb.addCamera("cam", sample.view);
  glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
