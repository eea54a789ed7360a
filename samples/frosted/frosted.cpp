// Four panes of decreasing collimation before things near and far, one of them pressed against the glass. PT17 fig. 8.
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr int kPanes = 4;
constexpr double kRoughness[kPanes] = {0.0, 0.25, 0.45, 0.8};
constexpr double kWidth = 0.56, kLeft = -1.12, kGlassZ = 0.0;

glm::dvec3 stripes(glm::dvec3 p) {
  return glm::mix(glm::dvec3(0.12, 0.14, 0.2), glm::dvec3(0.85, 0.8, 0.7),
                  std::abs(std::remainder(p.x + p.y, 0.36)) < 0.09 ? 1.0 : 0.0);
}

}  // namespace

Sample frosted() {
  Sample sample;
  sample.view.eye = {0.0, 0.75, 3.4};
  sample.view.target = {0.0, 0.62, 0.0};
  sample.view.yfov = 0.5;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.4, 0.8, 0.6));
  studio.sunIrradiance = {2.6, 2.5, 2.3};
  studio.ambient = {0.35, 0.38, 0.42};
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {5.0, 0.05, 5.0}, 0.0, checker({0.5, 0.48, 0.44}, {0.3, 0.29, 0.27}, 0.25)},
      {ShapeKind::box, {0.0, 1.5, -4.0}, {5.0, 1.5, 0.1}, 0.0, stripes},
  };
  // Behind every pane the same three: a box that touches the glass, a ball half a metre behind, a post farther off.
  for (int i = 0; i < kPanes; ++i) {
    const double x = kLeft + (i + 0.5) * kWidth;
    studio.shapes.push_back({ShapeKind::box,
                             {x - 0.13, 0.16, kGlassZ - 0.112},
                             {0.1, 0.16, 0.11},
                             0.0,
                             checker({0.75, 0.2, 0.12}, {0.55, 0.1, 0.06}, 0.08)});
    studio.shapes.push_back(
        {ShapeKind::sphere, {x + 0.12, 0.14, kGlassZ - 0.5}, {0.14, 0.0, 0.0}, 0.0, plain({0.12, 0.4, 0.75})});
    studio.shapes.push_back(
        {ShapeKind::cylinder, {x, 0.6, kGlassZ - 2.0}, {0.05, 0.6, 0.0}, 0.0, plain({0.85, 0.7, 0.1})});

    Mesh pane;
    addQuad(pane, {kLeft + i * kWidth + 0.01, 0.01, kGlassZ}, {kWidth - 0.02, 0.0, 0.0}, {0.0, 1.1, 0.0});
    const std::string name = "pane " + std::to_string(i);
    sample.glb.addMesh(name, pane, sample.glb.addMaterial(glass(name, {0.96, 0.98, 0.97}, 1.5, kRoughness[i])));
  }
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
