#include "composite/spread_pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/denormals.h"

namespace pellucid {
namespace {

// Texels beyond the picture whose footprint still reaches into it.
constexpr int kMargin = 2;
constexpr float kMask[4] = {0.125f, 0.375f, 0.375f, 0.125f};
// Texels in a standard deviation, at least. Measured in tests/scatter/diffusion_test.cpp.
constexpr float kTexelsPerSpread = 2.0f;
constexpr float kReach2 = shading::PLD_GAUSSIAN_REACH * shading::PLD_GAUSSIAN_REACH;

// Part of a texel's mass that lies at or below `limit`, if its pixels have one of two values.
float partBelow(float limit, float least, float mean, float most) {
  if (limit >= most) return 1.0f;
  if (limit < least) return 0.0f;
  return std::clamp((most - mean) / (most - least), 0.0f, 1.0f);
}

}  // namespace

int SpreadPyramid::levelFor(float spread) {
  int level = 0;
  for (float edge = 2.0f; edge * kTexelsPerSpread <= spread && level < 24; edge *= 2.0f) ++level;
  return level;
}

const SpreadPyramid::Texel& SpreadPyramid::Level::clamped(int x, int y) const {
  return texels.at(std::clamp(x, -kMargin, width + kMargin - 1) + kMargin,
                   std::clamp(y, -kMargin, height + kMargin - 1) + kMargin);
}

template <class Fetch>
SpreadPyramid::Level SpreadPyramid::halve(int width, int height, const Fetch& fetch) {
  Level level;
  level.width = (width + 1) / 2;
  level.height = (height + 1) / 2;
  level.texels = Image<Texel>(level.width + 2 * kMargin, level.height + 2 * kMargin);
  tbb::parallel_for(tbb::blocked_range<int>(0, level.texels.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < level.texels.width(); ++x) {
        Texel sum;
        sum.leastVariance = sum.leastRate = std::numeric_limits<float>::max();
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) {
            const Texel part = fetch(2 * (x - kMargin) - 1 + i, 2 * (y - kMargin) - 1 + j);
            if (part.mass <= 0.0f) continue;
            const float share = kMask[i] * kMask[j];
            sum.colour += share * part.colour;
            sum.mass += share * part.mass;
            sum.meanVariance += share * part.mass * part.meanVariance;
            sum.meanRate += share * part.mass * part.meanRate;
            sum.leastVariance = std::min(sum.leastVariance, part.leastVariance);
            sum.mostVariance = std::max(sum.mostVariance, part.mostVariance);
            sum.leastRate = std::min(sum.leastRate, part.leastRate);
            sum.mostRate = std::max(sum.mostRate, part.mostRate);
          }
        if (sum.mass > 0.0f) {
          sum.meanVariance /= sum.mass;
          sum.meanRate /= sum.mass;
        }
        level.texels.at(x, y) = sum;
      }
  });
  return level;
}

SpreadPyramid::SpreadPyramid(const Backdrop& backdrop, const OitPlanes& planes, float largestSpread) {
  const int width = backdrop.z.width(), height = backdrop.z.height();
  const auto pixel = [&](int x, int y) {
    const int cx = std::clamp(x, 0, width - 1), cy = std::clamp(y, 0, height - 1);
    Texel texel;
    const float variance = planes.refraction.at(cx, cy).w;
    const glm::vec4& colour = backdrop.colour.at(cx, cy);
    if (variance <= 0.0f || !std::isfinite(colour.r + colour.g + colour.b + colour.a)) return texel;
    texel.colour = colour;
    texel.mass = 1.0f;
    texel.leastVariance = texel.meanVariance = texel.mostVariance = variance;
    texel.leastRate = texel.meanRate = texel.mostRate = 1.0f / std::max(backdrop.z.at(cx, cy), 1e-30f);
    return texel;
  };
  levels_.push_back(halve(width, height, pixel));
  for (int k = levelFor(largestSpread); k > 1; --k) {
    const Level& last = levels_.back();
    Level next = halve(last.width, last.height, [&last](int x, int y) { return last.clamped(x, y); });
    levels_.push_back(std::move(next));
  }
}

Gathered SpreadPyramid::gather(glm::vec2 centre, float spread, float scattererZ) const {
  const int number = std::min(levelFor(spread), static_cast<int>(levels_.size()));
  const Level& level = levels_[static_cast<std::size_t>(number - 1)];
  const auto edge = static_cast<float>(1 << number);
  // In texels. What the footprints have spread already is left out of the weights.
  const glm::vec2 place = centre / edge;
  const float variance = spread * spread / (edge * edge);
  const float weightVariance = variance - 0.25f * (1.0f - 1.0f / (edge * edge));
  const float radius = shading::PLD_GAUSSIAN_REACH * std::sqrt(variance);
  const float rateLimit = 1.0f / std::max(shading::PLD_IN_FRONT * scattererZ, 1e-30f);
  const int x0 = static_cast<int>(std::ceil(place.x - radius - 0.5f));
  const int x1 = static_cast<int>(std::floor(place.x + radius - 0.5f));
  const int y0 = static_cast<int>(std::ceil(place.y - radius - 0.5f));
  const int y1 = static_cast<int>(std::floor(place.y + radius - 0.5f));
  thread_local std::vector<float> across;
  across.clear();
  for (int x = x0; x <= x1; ++x) {
    const float dx = static_cast<float>(x) + 0.5f - place.x;
    across.push_back(shading::gaussianWeight(dx * dx, weightVariance));
  }
  Gathered gathered;
  for (int y = y0; y <= y1; ++y) {
    const float dy = static_cast<float>(y) + 0.5f - place.y;
    const float down = shading::gaussianWeight(dy * dy, weightVariance);
    glm::vec4 rowColour(0.0f);
    float rowWeight = 0.0f;
    for (int x = x0; x <= x1; ++x) {
      const float dx = static_cast<float>(x) + 0.5f - place.x;
      const float r2 = dx * dx + dy * dy;
      if (r2 > kReach2 * variance) continue;
      const Texel& texel = level.clamped(x, y);
      if (texel.mass <= 0.0f) continue;
      // A pixel counts when its own variance is at least r^2 / kappa^2.
      const float needed = r2 * (edge * edge) / kReach2;
      float part = 1.0f;
      if (needed > texel.leastVariance)
        part = 1.0f - partBelow(needed, texel.leastVariance, texel.meanVariance, texel.mostVariance);
      if (rateLimit < texel.mostRate) part *= partBelow(rateLimit, texel.leastRate, texel.meanRate, texel.mostRate);
      const float weight = part * across[static_cast<std::size_t>(x - x0)];
      rowColour += weight * texel.colour;
      rowWeight += weight * texel.mass;
    }
    gathered.colour += glm::dvec4(rowColour) * static_cast<double>(down);
    gathered.weight += static_cast<double>(rowWeight) * static_cast<double>(down);
  }
  return gathered;
}

}  // namespace pellucid
