// A backdrop and what scatters before it, made by hand.
#pragma once
#include <limits>

#include "composite/gather.h"

namespace pellucid::test {

struct ScatterScene {
  Backdrop backdrop;
  OitPlanes planes;

  ScatterScene(int width, int height, glm::vec4 colour = glm::vec4(0, 0, 0, 1), float z = 10.0f) {
    const Window window{0, 0, width, height};
    backdrop.colour = Image<glm::vec4>(width, height, colour);
    backdrop.z = Image<float>(width, height, z);
    planes = emptyPlanes(window, window);
    addScatterPlanes(planes);
  }
  void diffuse(int x, int y, float spread, float layerZ = 5.0f) {
    planes.refraction.at(x, y).w = spread * spread;
    planes.diffuseZ.at(x, y) = spread > 0.0f ? layerZ : std::numeric_limits<float>::infinity();
  }
  void diffuseAll(float spread) {
    for (int y = 0; y < backdrop.z.height(); ++y)
      for (int x = 0; x < backdrop.z.width(); ++x) diffuse(x, y, spread);
  }
  void refract(int x, int y, glm::vec2 offset, float layerZ = 5.0f) {
    planes.refraction.at(x, y).x = offset.x;
    planes.refraction.at(x, y).y = offset.y;
    planes.refraction.at(x, y).z = 1.0f;
    planes.light.at(x, y).a = layerZ;
  }
  Image<glm::vec4> look(bool exact, int kernel = shading::PLD_DIFFUSE_GAUSSIAN) const {
    LookupSettings settings;
    settings.exact = exact;
    settings.kernel = kernel;
    const Lookups lookups(backdrop, planes, settings);
    Image<glm::vec4> seen(backdrop.z.width(), backdrop.z.height());
    for (int y = 0; y < seen.height(); ++y)
      for (int x = 0; x < seen.width(); ++x)
        seen.at(x, y) = lookups.scattersAt(x, y) ? lookups.at(x, y) : backdrop.colour.at(x, y);
    return seen;
  }
};

}  // namespace pellucid::test
