#include "composite/wide_gaussian.h"

#include <cmath>
#include <limits>

#include "composite/lanes.h"
#include "composite/wide_pyramid.h"

namespace pellucid::shading {

using lanes::Float8;
using lanes::Int8;
using lanes::kLanes;
using lanes::LossySum;
using Gathered = GatherText::Gathered;

namespace {

constexpr int kSums = 5;      // a colour and its weight
constexpr int kColumns = 32;  // weighed before they are summed: all that both need would not fit into registers
const Float8 kPlaces = {0, 1, 2, 3, 4, 5, 6, 7};

// What all rows of a Gaussian's taps share.
struct GaussianTaps {
  const Columns& pixels;
  vec2 centre;
  float variance, radius;
  float inFront;  // depths below it stand in front of the layer
  Window taps;
};

// Squared distances of eight rows from the centre, and infinite ones of those that are no taps.
inline void awayInRows(const GaussianTaps& of, int top, Float8& dy2) {
  const Float8 place = kPlaces + float(top);
  const Float8 dy = place + 0.5f - of.centre.y;
  dy2 = place < float(of.taps.y1) ? dy * dy : Float8{} + std::numeric_limits<float>::infinity();
}

// Logarithms of the weights of a column's taps in eight rows, and which of them count.
inline void weigh(const GaussianTaps& of, int x, int top, const Float8& dy2, Float8& logarithm, Int8& counts) {
  Float8 variance, depth;
  lanes::load(of.pixels.at(kTapVariance, x, top), variance);
  lanes::load(of.pixels.at(kTapDepth, x, top), depth);
  const float dx = float(x) + 0.5f - of.centre.x;
  const Float8 r2 = dx * dx + dy2;
  const Float8 least = variance < of.variance ? variance : Float8{} + of.variance;
  counts = (r2 <= PLD_GAUSSIAN_REACH * PLD_GAUSSIAN_REACH * least) & ~(depth < of.inFront);
  logarithm = -0.5f * r2 / of.variance;
}

// Adds columns that were weighed.
inline void addColumns(const GaussianTaps& of, int top, int count, const int* columns, const Float8* weights,
                       const Int8* counts, LossySum (&sums)[kSums]) {
  const std::size_t plane = of.pixels.planeStride();
  for (int i = 0; i < count; ++i) {
    const float* colour = of.pixels.at(kTapColour, columns[i], top);
    for (int k = 0; k < 4; ++k) {
      Float8 channel;
      lanes::load(colour + static_cast<std::size_t>(k) * plane, channel);
      sums[k].addWhere(counts[i], weights[i] * channel);
    }
    sums[4].addWhere(counts[i], weights[i]);
  }
}

// The taps of up to eight rows from `top` on.
inline void addRows(const GaussianTaps& of, int top, Float8 (&rows)[kLanes]) {
  const Window& known = of.pixels.window();
  if (top + kLanes <= known.y0 || top >= known.y1) return;
  // Beyond the circle nothing counts; a pixel is left for rounding.
  const float nearest =
      std::max(0.0f, std::max(float(top) + 0.5f - of.centre.y, of.centre.y - (float(top + kLanes - 1) + 0.5f)));
  const float half = std::sqrt(std::max(0.0f, of.radius * of.radius - nearest * nearest)) + 1.0f;
  const int begin = std::max({of.taps.x0, known.x0, int(std::floor(of.centre.x - 0.5f - half))});
  const int end = std::min({of.taps.x1, known.x1, int(std::ceil(of.centre.x - 0.5f + half)) + 1});
  Float8 dy2;
  awayInRows(of, top, dy2);
  LossySum sums[kSums];
  Float8 weights[kColumns];
  Int8 counts[kColumns];
  int columns[kColumns];
  for (int x = begin; x < end;) {
    int count = 0;
    for (const int stop = std::min(end, x + kColumns); x < stop; ++x) {
      columns[count] = x;
      weigh(of, x, top, dy2, weights[count], counts[count]);
      count += lanes::anyOf(counts[count]) ? 1 : 0;
    }
    for (int i = 0; i < count; ++i) lanes::expOf(weights[i], weights[i]);  // each waits long, but for no other
    addColumns(of, top, count, columns, weights, counts, sums);
  }
  const Float8 values[kSums] = {sums[0].value, sums[1].value, sums[2].value, sums[3].value, sums[4].value};
  lanes::byRows(values, rows);
}

}  // namespace

PLD_CLONES void gaussianRows(const GaussianTaps& of, Float8& result) {
  LossySum sum;
  for (int top = of.taps.y0; top < of.taps.y1; top += kLanes) {
    Float8 rows[kLanes] = {};
    addRows(of, top, rows);
    const int count = std::min(kLanes, of.taps.y1 - top);
    for (int k = 0; k < count; ++k) sum.add(rows[k]);
  }
  result = sum.value;
}

std::optional<Gathered> wideGaussian(const GatherText& text, vec2 centre, float spread, float layerZ) {
  const float radius = PLD_GAUSSIAN_REACH * spread;
  const Window taps{int(ceil(centre.x - radius - 0.5f)), int(ceil(centre.y - radius - 0.5f)),
                    int(floor(centre.x + radius - 0.5f)) + 1, int(floor(centre.y + radius - 0.5f)) + 1};
  if (taps.x0 < 0 || taps.y0 < 0 || taps.x1 > text.width() || taps.y1 > text.height()) return std::nullopt;
  // A tap without a spread of its own counts at no distance at all.
  if (centre.x - 0.5f == floor(centre.x - 0.5f) && centre.y - 0.5f == floor(centre.y - 0.5f)) {
    const ivec2 middle(int(floor(centre.x)), int(floor(centre.y)));
    if (!(text.spreadAt(middle) > 0.0f)) return std::nullopt;
  }
  Float8 sum;
  gaussianRows({text.taps, centre, spread * spread, radius, PLD_IN_FRONT * layerZ, taps}, sum);
  Gathered gathered{};
  gathered.colour = vec4(sum[0], sum[1], sum[2], sum[3]);
  gathered.weight = sum[4];
  return gathered;
}

Gathered LookupText::gatherSpread(LookupChoice settings, vec2 centre, float variance, float layerZ) {
  if (settings.kernel == PLD_DIFFUSE_DISC) return gatherDisc(centre, variance, layerZ);
  const float spread = kernelSpread(variance, settings.largestSpread);
  const int level = settings.exact != 0 ? 0 : min(spreadLevel(spread), settings.levels);
  const std::optional<Gathered> wide =
      level == 0 ? wideGaussian(*this, centre, spread, layerZ) : widePyramid(*this, level, centre, spread, layerZ);
  if (wide) return *wide;
  return level == 0 ? gatherGaussian(centre, spread, layerZ) : gatherPyramid(level, centre, spread, layerZ);
}

}  // namespace pellucid::shading
