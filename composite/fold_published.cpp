#include "composite/fold_published.h"

#include <algorithm>

#include "composite/denormals.h"
#include "composite/fold.h"

namespace pellucid {
namespace {

// Fixed-function blending of 8-bit targets: the source becomes steps first, and every result is rounded to them.
void blend(const shading::PublishedTargets& layer, PublishedPixel& pixel) {
  for (int c = 0; c < 4; ++c) pixel.radiance[c] = shading::roundedToHalf(pixel.radiance[c] + layer.radiance[c]);
  for (int c = 0; c < 3; ++c) {
    const int passed = 255 - shading::unormOf(layer.beta[c]);
    pixel.beta[c] = static_cast<std::uint8_t>((pixel.beta[c] * passed + 127) / 255);
  }
  pixel.beta[3] = static_cast<std::uint8_t>(std::min(pixel.beta[3] + shading::unormOf(layer.beta.a), 255));
  for (int c = 0; c < 2; ++c)
    pixel.delta[c] = static_cast<std::int8_t>(std::clamp(pixel.delta[c] + shading::snormOf(layer.delta[c]), -127, 127));
}

// The targets that planes were decoded from.
PublishedPixel pixelOf(const OitPlanes& planes, int x, int y) {
  PublishedPixel pixel;
  pixel.radiance = glm::vec4(glm::vec3(planes.radiance.at(x, y)), planes.weight.at(x, y).r);
  for (int c = 0; c < 3; ++c) pixel.beta[c] = static_cast<std::uint8_t>(shading::unormOf(planes.depth.at(x, y)[c]));
  if (!planes.scatters()) return pixel;
  const float kUnit = shading::PLD_SCATTER_UNIT;
  const glm::vec4 refraction = planes.refraction.at(x, y);
  pixel.beta[3] = static_cast<std::uint8_t>(shading::unormOf(refraction.w / (kUnit * kUnit)));
  for (int c = 0; c < 2; ++c) pixel.delta[c] = static_cast<std::int8_t>(shading::snormOf(refraction[c] / kUnit));
  return pixel;
}

}  // namespace

shading::PublishedTargets publishedLayer(const shading::OitSums& sums, float variance) {
  shading::Scatter straight;
  straight.offset = glm::vec2(0.0f);
  straight.variance = variance;
  const glm::vec3 opacity = shading::netOpacityOf(sums.depth, shading::transmittanceOf(sums.depth));
  // What only adds light has no place in these targets.
  return shading::publishedTargets(sums.numerator, shading::meanOf(sums.denominator), opacity, straight);
}

void blendPublished(const shading::PublishedTargets& layer, OitPlanes& planes, int x, int y, PublishedClamps& clamps) {
  PublishedPixel pixel = pixelOf(planes, x, y);
  clamps.written += static_cast<std::uint64_t>(layer.clamped);
  blend(layer, pixel);
  storePublished(pixel, planes, x, y, clamps);
}

void foldPublished(const FragmentLists& lists, const shading::WeightSettings& weight, OitPlanes& planes,
                   PublishedClamps& clamps) {
  const FlushDenormals flush;
  copySolids(lists, planes);
  if (anyScatters(lists)) addScatterPlanes(planes);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  std::size_t at = 0;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x, ++at) {
      PublishedPixel pixel;
      for (std::uint64_t i = lists.offsets[at]; i < lists.offsets[at + 1]; ++i) {
        const Fragment& fragment = lists.fragments[i];
        if (!takesPart(fragment, lists.solid.at(x, y))) continue;
        const shading::PublishedTargets layer =
            shading::packPublished(layerFrom(fragment), scatterFrom(fragment), weight);
        clamps.written += static_cast<std::uint64_t>(layer.clamped);
        blend(layer, pixel);
      }
      storePublished(pixel, planes, left + x, top + y, clamps);
    }
}

}  // namespace pellucid
