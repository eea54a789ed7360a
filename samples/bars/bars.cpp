// Two woven rows of coloured glass bars in front of a white and a dark wall. PT17 fig. 7.
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

struct Filter {
  const char* name;
  glm::dvec3 colour;  // transmission, [0,1] linear
};
constexpr int kBars = 6;
const Filter kFilters[kBars] = {{"red", {0.90, 0.10, 0.10}},     {"green", {0.10, 0.80, 0.15}},
                                {"blue", {0.10, 0.20, 0.90}},    {"cyan", {0.10, 0.80, 0.90}},
                                {"magenta", {0.90, 0.10, 0.80}}, {"yellow", {0.95, 0.85, 0.10}}};

}  // namespace

Sample bars() {
  Sample sample;
  sample.view.eye = {0.0, 0.0, 3.0};

  sample.studio.ambient = glm::dvec3(1.0);
  const Albedo wall = [](glm::dvec3 p) { return glm::dvec3(p.x > 0.5 + 0.45 * p.y ? 0.04 : 0.9); };
  sample.studio.shapes.push_back({ShapeKind::box, {0.0, 0.0, -1.3}, {4.0, 3.0, 0.1}, 0.0, wall});

  // ior 1 reflects nothing: pure filters, which commute. Upright bars stand at z = 0; the others slant through them,
  // so that no order of whole bars is right.
  for (int i = 0; i < kBars; ++i) {
    const Filter& filter = kFilters[i];
    const int material = sample.glb.addMaterial(glass(filter.name, filter.colour, 1.0, 0.0));
    const double x = (i - 2.5) * 0.42, y = (2.5 - i) * 0.26, slant = (i % 2 == 0 ? 0.12 : -0.12);
    Mesh upright, across;
    addQuad(upright, {x - 0.11, -0.82, 0.0}, {0.22, 0.0, 0.0}, {0.0, 1.64, 0.0});
    addQuad(across, {-1.35, y - 0.075, slant}, {2.7, 0.0, -2.0 * slant}, {0.0, 0.15, 0.0});
    sample.glb.addMesh(std::string("upright ") + filter.name, upright, material);
    sample.glb.addMesh(std::string("across ") + filter.name, across, material);
  }
  sample.glb.addCamera("cam", sample.view);
  return sample;
}

}  // namespace pellucid::samples
