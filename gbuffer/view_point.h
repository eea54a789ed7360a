// Where a pixel of a G-buffer lies.
#pragma once
#include "gbuffer/gbuffer.h"

namespace pellucid {

// At a planar depth, in metres, seen through pixel (x, y) of the data window, its centre at whole numbers. View space.
inline glm::dvec3 viewPoint(const GBuffer& gbuffer, const Camera& camera, glm::dvec2 pixel, double z) {
  const glm::dvec2 size(gbuffer.display.width(), gbuffer.display.height());
  const glm::dvec2 at =
      pixel + glm::dvec2(gbuffer.data.x0 - gbuffer.display.x0 + 0.5, gbuffer.data.y0 - gbuffer.display.y0 + 0.5);
  const glm::dvec2 ndc(2.0 * at.x / size.x - 1.0, 1.0 - 2.0 * at.y / size.y);
  const glm::dvec2 atOne = (ndc - camera.centre) / camera.focal;
  return camera.orthographic ? glm::dvec3(atOne, -z) : glm::dvec3(atOne * z, -z);
}

// Of the centre of pixel (x, y) of the data window, whose depth is finite.
inline glm::dvec3 viewPoint(const GBuffer& gbuffer, const Camera& camera, int x, int y) {
  return viewPoint(gbuffer, camera, glm::dvec2(x, y), static_cast<double>(gbuffer.viewZ.at(x, y)));
}

}  // namespace pellucid
