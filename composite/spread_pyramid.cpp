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
// A tap with this part of the kernel's variance, or more, leaves out less than 0.3% of it.
constexpr float kTail = 0.75f;
// Taps below this part of the centre's weight, 3% of the kernel in all, are not taken apart.
constexpr float kFaint = 0.03f;
// And those above this part, where parts are few pixels wide, are taken apart down to the pixel.
constexpr float kNear = 0.3f;
// How far the parts that the mask adds lie from the texel's centre, in texels.
constexpr float kParts = 0.75f;
// Texels in a standard deviation, at least. Measured in tests/scatter/diffusion_test.cpp.
constexpr float kTexelsPerSpread = 2.0f;
const float kReach2 = shading::PLD_GAUSSIAN_REACH * shading::PLD_GAUSSIAN_REACH;

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

void SpreadPyramid::addTo(Property& sum, const Property& part, float share) {
  sum.least = std::min(sum.least, part.least);
  sum.most = std::max(sum.most, part.most);
  sum.mass += share * part.mass;
  sum.colour += share * part.colour;
}

SpreadPyramid::Part SpreadPyramid::above(const Texel& texel, const Property& property, float limit) {
  if (limit < property.least) return {texel.colour, texel.mass};
  if (limit >= property.most) return {glm::vec4(0.0f), 0.0f};
  // With values `least` and `most` alone: sum = low + high, moment = low least + high most.
  const float span = 1.0f / (property.most - property.least);
  const float mass = std::clamp((property.mass - property.least * texel.mass) * span, 0.0f, texel.mass);
  const glm::vec4 colour = (property.colour - property.least * texel.colour) * span;
  // Rounding, and a third value, must not make more light than there is.
  return {glm::clamp(colour, glm::min(texel.colour, 0.0f), glm::max(texel.colour, 0.0f)), mass};
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
        sum.variance.least = sum.rate.least = std::numeric_limits<float>::max();
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) {
            const Texel part = fetch(2 * (x - kMargin) - 1 + i, 2 * (y - kMargin) - 1 + j);
            if (part.mass <= 0.0f) continue;
            const float share = kMask[i] * kMask[j];
            sum.colour += share * part.colour;
            sum.mass += share * part.mass;
            addTo(sum.variance, part.variance, share);
            addTo(sum.rate, part.rate, share);
          }
        level.texels.at(x, y) = sum;
      }
  });
  return level;
}

SpreadPyramid::Texel SpreadPyramid::pixel(int x, int y) const {
  const int cx = std::clamp(x, 0, backdrop_.z.width() - 1), cy = std::clamp(y, 0, backdrop_.z.height() - 1);
  Texel texel;
  const float variance = planes_.refraction.at(cx, cy).w;
  const glm::vec4& colour = backdrop_.colour.at(cx, cy);
  if (variance <= 0.0f || !std::isfinite(colour.r + colour.g + colour.b + colour.a)) return texel;
  texel.colour = colour;
  texel.mass = 1.0f;
  const float rate = 1.0f / std::max(backdrop_.z.at(cx, cy), 1e-30f);
  texel.variance = {variance, variance, variance, variance * colour};
  texel.rate = {rate, rate, rate, rate * colour};
  return texel;
}

SpreadPyramid::Texel SpreadPyramid::texelAt(int number, int x, int y) const {
  return number == 0 ? pixel(x, y) : levels_[static_cast<std::size_t>(number - 1)].clamped(x, y);
}

SpreadPyramid::SpreadPyramid(const Backdrop& backdrop, const OitPlanes& planes, float largestSpread)
    : backdrop_(backdrop), planes_(planes) {
  levels_.push_back(halve(backdrop.z.width(), backdrop.z.height(), [this](int x, int y) { return pixel(x, y); }));
  for (int k = levelFor(largestSpread); k > 1; --k) {
    const Level& last = levels_.back();
    Level next = halve(last.width, last.height, [&last](int x, int y) { return last.clamped(x, y); });
    levels_.push_back(std::move(next));
  }
}

SpreadPyramid::Part SpreadPyramid::passing(const Texel& texel, float needed, float rateLimit) {
  Part part{texel.colour, texel.mass};
  if (needed > texel.variance.least) part = above(texel, texel.variance, needed);
  if (rateLimit < texel.rate.most) {
    const Part inFront = above(texel, texel.rate, rateLimit);
    const float kept = part.mass / texel.mass;
    part = {kept * (texel.colour - inFront.colour), kept * (texel.mass - inFront.mass)};
  }
  return part;
}

SpreadPyramid::Part SpreadPyramid::passingParts(int number, int x, int y, glm::vec2 centre, float rateLimit,
                                                bool deeper) const {
  const float edge = 0.5f * static_cast<float>(1 << number);
  Part sum{glm::vec4(0.0f), 0.0f};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int px = 2 * x - 1 + i, py = 2 * y - 1 + j;
      const Texel texel = texelAt(number - 1, px, py);
      if (texel.mass <= 0.0f) continue;
      const float dx = (static_cast<float>(px) + 0.5f) * edge - centre.x;
      const float dy = (static_cast<float>(py) + 0.5f) * edge - centre.y;
      const float needed = (dx * dx + dy * dy) / kReach2;
      const bool spreads = texel.variance.least < texel.variance.most && texel.variance.least < 4.0f * needed;
      const bool mixed = spreads || (rateLimit >= texel.rate.least && rateLimit < texel.rate.most);
      const Part part = deeper && mixed ? passingParts(number - 1, px, py, centre, rateLimit, number == 3)
                                        : passing(texel, needed, rateLimit);
      const float share = kMask[i] * kMask[j];
      sum.colour += share * part.colour;
      sum.mass += share * part.mass;
    }
  return sum;
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
      // A pixel counts when its own variance is at least r^2 / kappa^2; the texel's parts lie up to kParts away.
      const float nearX = std::max(std::abs(dx) - kParts, 0.0f), nearY = std::max(std::abs(dy) - kParts, 0.0f);
      const float farX = std::abs(dx) + kParts, farY = std::abs(dy) + kParts;
      const float least = (nearX * nearX + nearY * nearY) * (edge * edge) / kReach2;
      const float most = (farX * farX + farY * farY) * (edge * edge) / kReach2;
      const float weight = across[static_cast<std::size_t>(x - x0)];
      Part part{texel.colour, texel.mass};
      if (least > texel.variance.most || rateLimit < texel.rate.least) continue;
      // Where the tap's own spread ends the kernel before its tail, the end must lie at its place.
      const bool cuts = most > texel.variance.least && texel.variance.least < kTail * spread * spread;
      if (cuts || rateLimit < texel.rate.most)
        part = weight * down < kFaint ? passing(texel, r2 * (edge * edge) / kReach2, rateLimit)
                                      : passingParts(number, x, y, centre, rateLimit,
                                                     number == 2 || (number == 3 && weight * down > kNear));
      rowColour += weight * part.colour;
      rowWeight += weight * part.mass;
    }
    gathered.colour += glm::dvec4(rowColour) * static_cast<double>(down);
    gathered.weight += static_cast<double>(rowWeight) * static_cast<double>(down);
  }
  return gathered;
}

}  // namespace pellucid
