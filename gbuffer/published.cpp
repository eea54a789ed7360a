#include "gbuffer/published.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {

void completePublished(OitPlanes& planes, int x, int y) {
  const float weight = planes.weight.at(x, y).r;
  bool touched = weight != 0.0f || glm::vec3(planes.radiance.at(x, y)) != glm::vec3(0.0f) ||
                 glm::vec3(planes.depth.at(x, y)) != glm::vec3(1.0f);
  if (planes.scatters()) {
    glm::vec4& refraction = planes.refraction.at(x, y);
    const bool bends = refraction.x != 0.0f || refraction.y != 0.0f, spreads = refraction.w > 0.0f;
    // Offsets are summed, not averaged, and no depth says what stands in front: the listings do neither.
    refraction.z = bends ? 1.0f : 0.0f;
    planes.diffuseZ.at(x, y) = spreads ? 0.0f : std::numeric_limits<float>::infinity();
    touched = touched || bends || spreads;
  }
  planes.weight.at(x, y) = glm::vec4(glm::vec3(weight), touched ? 1.0f : 0.0f);
}

void storePublished(const PublishedPixel& pixel, OitPlanes& planes, int x, int y, PublishedClamps& clamps) {
  glm::vec4 beta;
  for (int c = 0; c < 4; ++c) beta[c] = shading::fromUnorm(pixel.beta[c]);
  const glm::vec2 delta(shading::fromSnorm(pixel.delta[0]), shading::fromSnorm(pixel.delta[1]));
  const shading::PublishedSums sums = shading::unpackPublished(pixel.radiance, beta, delta);

  const float largest =
      std::max(std::max(pixel.radiance.r, pixel.radiance.g), std::max(pixel.radiance.b, pixel.radiance.a));
  if (largest >= shading::PLD_HALF_LARGEST) ++clamps.radiance;
  if (pixel.beta[3] == 255) ++clamps.diffusion;
  if (std::abs(pixel.delta[0]) >= 127 || std::abs(pixel.delta[1]) >= 127) ++clamps.refraction;

  // Infinity would be damage in a file; above the largest half the decoder knows a sum that was cut.
  const glm::vec4 cut = glm::min(pixel.radiance, glm::vec4(2.0f * shading::PLD_HALF_LARGEST));
  planes.radiance.at(x, y) = glm::vec4(glm::vec3(cut), 0.0f);
  planes.weight.at(x, y).r = cut.a;
  planes.depth.at(x, y) = glm::vec4(sums.beta, 0.0f);
  if (planes.scatters()) planes.refraction.at(x, y) = glm::vec4(sums.offset, 0.0f, sums.variance);
  completePublished(planes, x, y);
}

}  // namespace pellucid
