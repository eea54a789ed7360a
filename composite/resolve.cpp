#include "composite/resolve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "composite/denormals.h"

namespace pellucid {
namespace {

// 0 hides even what is not finite; for finite light this changes no bit.
glm::vec3 through(const glm::vec3& transmission, const glm::vec3& light) {
  return {transmission.r > 0.0f ? light.r : 0.0f, transmission.g > 0.0f ? light.g : 0.0f,
          transmission.b > 0.0f ? light.b : 0.0f};
}

}  // namespace

Veil resolve(const OitPlanes& planes, const ResolveSettings& settings) {
  const int width = planes.data.width(), height = planes.data.height();
  Veil veil(width, height);
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        const shading::OitSums sums = shading::unpackSums(planes.at(x, y));
        const glm::vec4 solid = planes.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        if (sums.count == 0.0f && !hasSolid) continue;
        shading::Resolved resolved = shading::resolveSums(sums, settings.selfModulation);
        if (hasSolid) {
          resolved.transparent = shading::overBackground(resolved, glm::vec3(solid));
          resolved.transmission = glm::vec3(0.0f);
        }
        veil.light.at(x, y) = resolved.transparent;
        veil.transmission.at(x, y) = resolved.transmission;
        veil.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), solid.a);
        veil.touched.at(x, y) = 1;
      }
  });
  return veil;
}

Picture compose(const Veil& veil, const GBuffer& background) {
  const int width = veil.touched.width(), height = veil.touched.height();
  Picture picture{background.beauty, veil.touched};
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        if (!veil.touched.at(x, y)) continue;
        glm::vec4& pixel = picture.rgba.at(x, y);
        shading::Resolved resolved;
        resolved.transparent = veil.light.at(x, y);
        resolved.transmission = veil.transmission.at(x, y);
        const glm::vec3 colour = shading::overBackground(resolved, through(resolved.transmission, glm::vec3(pixel)));
        pixel = glm::vec4(colour, shading::alphaOver(resolved.transmission, pixel.a));
      }
  });
  return picture;
}

}  // namespace pellucid
