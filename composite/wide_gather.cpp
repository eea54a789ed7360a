#include "composite/wide_gather.h"

#include <cmath>
#include <cstddef>

#include "composite/lanes.h"

namespace pellucid::shading {

using lanes::Float8;
using lanes::Int8;
using lanes::kLanes;
using lanes::LossySum;
using Gathered = GatherText::Gathered;

namespace {

constexpr int kRows = 4;  // summed side by side: one sum alone waits for its own last addition

// A body begins with the five numbers that are summed.
static_assert(offsetof(SpreadTexel, body) == 0 && offsetof(SpreadBody, colour) == 0 &&
              offsetof(SpreadBody, mass) == 4 * sizeof(float) && sizeof(SpreadBody) >= sizeof(Float8));

Gathered gatheredFrom(const Float8& sum) {
  Gathered gathered{};
  gathered.colour = vec4(sum[0], sum[1], sum[2], sum[3]);
  gathered.weight = sum[4];
  return gathered;
}

const Float8 kPlaces = {0, 1, 2, 3, 4, 5, 6, 7};

// What all rows of a Gaussian's taps share.
struct GaussianTaps {
  const GatherText& text;
  vec2 centre;
  float variance, radius;
  float inFront;  // depths below it stand in front of the layer
  Window taps;
};

// Weights of eight taps of a row, and which of them count.
//   end  of the row's taps
inline void weigh(const GaussianTaps& of, int x, int end, int y, Float8& weight, Int8& counts) {
  const GatherText& text = of.text;
  Float8 variance, depth{};
  lanes::load(&text.spreadOfTaps.at(x - text.diffusing.x0, y - text.diffusing.y0), variance);
  const float* z = text.backdrop.z->row(y) + x;
  if (x + kLanes <= text.width())
    lanes::load(z, depth);
  else
    std::memcpy(&depth, z, static_cast<std::size_t>(text.width() - x) * sizeof(float));
  const float dy = float(y) + 0.5f - of.centre.y;
  const Float8 place = kPlaces + float(x);
  const Float8 dx = place + 0.5f - of.centre.x;
  const Float8 r2 = dx * dx + dy * dy;
  const Float8 least = variance < of.variance ? variance : Float8{} + of.variance;
  counts = (r2 <= PLD_GAUSSIAN_REACH * PLD_GAUSSIAN_REACH * least) & ~(depth < of.inFront) & (place < float(end));
  lanes::expOf(-0.5f * r2 / of.variance, weight);
}

// The taps of up to kRows rows from `top` on, which lie in what diffuses.
inline void addRows(const GaussianTaps& of, int top, LossySum (&rows)[kRows]) {
  const GatherText& text = of.text;
  const Window& known = text.diffusing;
  // Beyond the circle nothing counts; a pixel is left for rounding.
  const float nearest =
      std::max(0.0f, std::max(float(top) + 0.5f - of.centre.y, of.centre.y - (float(top + kRows - 1) + 0.5f)));
  const float half = std::sqrt(std::max(0.0f, of.radius * of.radius - nearest * nearest)) + 1.0f;
  const int begin = std::max({of.taps.x0, known.x0, int(std::floor(of.centre.x - 0.5f - half))});
  const int end = std::min({of.taps.x1, known.x1, int(std::ceil(of.centre.x - 0.5f + half)) + 1});
  alignas(32) float weight[kRows][kLanes];
  alignas(32) std::int32_t counts[kRows][kLanes];
  const vec4* colours[kRows];
  for (int k = 0; k < kRows; ++k) colours[k] = text.backdrop.colour->row(std::clamp(top + k, known.y0, known.y1 - 1));
  for (int x = begin; x < end; x += kLanes) {
    for (int k = 0; k < kRows; ++k) {
      const int y = top + k;
      Float8 weights{};
      Int8 taken{};
      if (y >= known.y0 && y < known.y1 && y < of.taps.y1) weigh(of, x, end, y, weights, taken);
      std::memcpy(weight[k], &weights, sizeof weights);
      std::memcpy(counts[k], &taken, sizeof taken);
    }
    const int lanesUsed = std::min(kLanes, end - x);
    for (int i = 0; i < lanesUsed; ++i)
#pragma GCC unroll 4
      for (int k = 0; k < kRows; ++k) {
        Float8 tap;
        lanes::loadFourAndOne(&colours[k][x + i].r, tap);
        rows[k].addWhere(Int8{} + counts[k][i], tap * weight[k][i]);
      }
  }
}

}  // namespace

PLD_CLONES void gaussianRows(const GaussianTaps& of, Float8& result) {
  const Window& known = of.text.diffusing;
  LossySum sum;
  for (int top = of.taps.y0; top < of.taps.y1; top += kRows) {
    LossySum rows[kRows];
    if (top + kRows > known.y0 && top < known.y1) addRows(of, top, rows);
    const int count = std::min(kRows, of.taps.y1 - top);
    for (int k = 0; k < count; ++k) sum.add(rows[k].value);
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
  gaussianRows({text, centre, spread * spread, radius, PLD_IN_FRONT * layerZ, taps}, sum);
  return gatheredFrom(sum);
}

namespace {

// What all rows of a pyramid's taps share; lengths in texels where nothing else is said.
struct PyramidTaps {
  GatherText& text;
  const SpreadLevel& texels;
  int level;
  vec2 centre;  // pixels
  float edge;   // pixels
  vec2 place;
  float weightVariance, most2;
  float tailReach, rateLimit;  // pixels, 1/metres
  float fine;
  Window taps;
};

// A texel that is not simply seen whole: what of it is seen.
[[gnu::noinline]] bool seenPart(const PyramidTaps& of, ivec2 texel, float r2, float centreWeight, SpreadBody& body) {
  const SpreadTexel& all = of.text.spreadTexel(of.level, texel);
  body = all.body;
  if (body.mass <= 0.0f) return false;
  const float away = of.edge * sqrt(r2);
  if (passesWhole(body, away, of.edge, of.tailReach, of.rateLimit)) return true;
  if (body.leastRate > of.rateLimit || body.mostReach <= away - PLD_SPREAD_PARTS * of.edge) return false;
  if (centreWeight < of.fine || !isCut(body, away, of.edge))
    body = passingPart(all, away, of.edge, of.rateLimit);
  else
    body = of.text.passingParts(of.level, texel, of.centre, of.rateLimit);
  return true;
}

void gaussianWeights(int first, int end, float place, float variance, float* weights) {
  for (int x = first; x < end; x += kLanes) {
    const Float8 d = kPlaces + float(x) + 0.5f - place;
    Float8 weight;
    lanes::expOf(-0.5f * (d * d) / variance, weight);
    std::memcpy(weights + (x - first), &weight, sizeof weight);
  }
}

inline void addBody(const float* body, float weight, Float8& row) {
  Float8 sums;
  lanes::load(body, sums);
  row += weight * sums;
}

// Weights of a row's taps within the kernel's reach, 0 beyond and where nothing diffuses; and whether all the others
// are seen whole: passesWhole() of each.
//   begin, end  of the row's taps that are stored
//   whole       -1 where a texel is
inline bool weighRow(const PyramidTaps& of, int y, int begin, int end, const float* across, float* weights,
                     std::int32_t* whole) {
  const SpreadLevel& texels = of.texels;
  const float dy = float(y) + 0.5f - of.place.y;
  const float* reaches = &texels.leastReach.at(begin - texels.stored.x0, y - texels.stored.y0);
  const float* rates = &texels.mostRate.at(begin - texels.stored.x0, y - texels.stored.y0);
  Int8 missed{};
  for (int x = begin; x < end; x += kLanes) {
    Float8 reach, rate, weight;
    lanes::load(reaches + (x - begin), reach);
    lanes::load(rates + (x - begin), rate);
    lanes::load(across + (x - of.taps.x0), weight);
    const Float8 place = kPlaces + float(x);
    const Float8 dx = place + 0.5f - of.place.x;
    const Float8 r2 = dx * dx + dy * dy;
    const Int8 near = (r2 <= of.most2) & (place < float(end)) & (reach >= 0.0f);
    alignas(32) float away[kLanes];
    std::memcpy(away, &r2, sizeof away);
    for (float& one : away) one = of.edge * std::sqrt(one) + PLD_SPREAD_PARTS * of.edge;
    Float8 far;
    lanes::load(away, far);
    const Int8 seen = (rate <= of.rateLimit) & ((reach >= of.tailReach) | (reach >= far));
    missed |= near & ~seen;
    std::memcpy(whole + (x - begin), &seen, sizeof seen);
    weight = near ? weight : Float8{};
    std::memcpy(weights + (x - begin), &weight, sizeof weight);
  }
  std::int32_t any[kLanes];
  std::memcpy(any, &missed, sizeof any);
  return !(any[0] | any[1] | any[2] | any[3] | any[4] | any[5] | any[6] | any[7]);
}

// A row of which some texels are not seen whole.
inline void addRow(const PyramidTaps& of, int y, int begin, int end, const float* weights, const std::int32_t* whole,
                   float down, Float8& row) {
  const SpreadLevel& texels = of.texels;
  const float dy = float(y) + 0.5f - of.place.y;
  const SpreadTexel* bodies = texels.texels.row(y - texels.stored.y0) + (begin - texels.stored.x0);
  Float8 sum = row;
  for (int i = 0; i < end - begin; ++i) {
    const float weight = weights[i];
    if (weight == 0.0f) continue;
    if (whole[i]) {
      addBody(&bodies[i].body.colour.x, weight, sum);
      continue;
    }
    const float dx = float(begin + i) + 0.5f - of.place.x;
    SpreadBody body;
    if (seenPart(of, ivec2(begin + i, y), dx * dx + dy * dy, weight * down, body)) addBody(&body.colour.x, weight, sum);
  }
  row = sum;
}

constexpr int kRoom = (PLD_SPREAD_TAPS + 2 * kLanes) / kLanes * kLanes;

// Up to kRows rows from `top` on, whose sums do not depend on one another. A weight of 0 adds nothing.
inline void addPyramidRows(const PyramidTaps& of, int top, int count, const float* across, const float* down,
                           Float8 (&rows)[kRows]) {
  const Window& stored = of.texels.stored;
  const int begin = std::max(of.taps.x0, stored.x0), end = std::min(of.taps.x1, stored.x1);
  if (begin >= end) return;
  alignas(32) float weights[kRows][kRoom];
  alignas(32) std::int32_t seen[kRows][kRoom];
  const float* bodies[kRows];
  bool whole = count == kRows;
  for (int k = 0; k < kRows; ++k) {
    const int y = std::clamp(top + k, stored.y0, stored.y1 - 1);
    bodies[k] = &of.texels.texels.at(begin - stored.x0, y - stored.y0).body.colour.x;
    if (k >= count) continue;
    if (top + k != y) {
      whole = false;
      continue;
    }
    whole = weighRow(of, y, begin, end, across, weights[k], seen[k]) && whole;
  }
  if (!whole) {
    for (int k = 0; k < count; ++k)
      if (top + k >= stored.y0 && top + k < stored.y1)
        addRow(of, top + k, begin, end, weights[k], seen[k], down[top + k - of.taps.y0], rows[k]);
    return;
  }
  constexpr std::size_t kStride = sizeof(SpreadTexel) / sizeof(float);
  for (int i = 0; i < end - begin; ++i)
#pragma GCC unroll 4
    for (int k = 0; k < kRows; ++k) {
      Float8 sums;
      lanes::load(bodies[k] + static_cast<std::size_t>(i) * kStride, sums);
      rows[k] += weights[k][i] * sums;
    }
}

}  // namespace

PLD_CLONES void pyramidRows(const PyramidTaps& of, Float8& result) {
  const Window& taps = of.taps;
  alignas(32) float across[kRoom], down[kRoom];
  gaussianWeights(taps.x0, taps.x1, of.place.x, of.weightVariance, across);
  gaussianWeights(taps.y0, taps.y1, of.place.y, of.weightVariance, down);
  LossySum sum;
  for (int top = taps.y0; top < taps.y1; top += kRows) {
    Float8 rows[kRows] = {};
    const int count = std::min(kRows, taps.y1 - top);
    addPyramidRows(of, top, count, across, down, rows);
    for (int k = 0; k < count; ++k) sum.add(down[top + k - taps.y0] * rows[k]);
  }
  result = sum.value;
}

std::optional<Gathered> widePyramid(GatherText& text, int level, vec2 centre, float spread, float layerZ) {
  const SpreadLevel& texels = text.spreadLevels[static_cast<std::size_t>(level - 1)];
  const float edge = float(1 << level);
  const vec2 place = centre / edge;
  const float variance = spread * spread / (edge * edge);
  const float radius = PLD_GAUSSIAN_REACH * sqrt(variance);
  Window taps{int(ceil(place.x - radius - 0.5f)), int(ceil(place.y - radius - 0.5f)),
              int(floor(place.x + radius - 0.5f)) + 1, int(floor(place.y + radius - 0.5f)) + 1};
  taps.x1 = std::min(taps.x1, taps.x0 + PLD_SPREAD_TAPS);
  constexpr int margin = PLD_SPREAD_MARGIN + SpreadLevel::kRepeated;
  if (taps.x0 < -margin || taps.y0 < -margin || taps.x1 > texels.width + margin || taps.y1 > texels.height + margin ||
      taps.height() > PLD_SPREAD_TAPS)
    return std::nullopt;
  Float8 sum;
  pyramidRows({text, texels, level, centre, edge, place, variance - 0.25f * (1.0f - 1.0f / (edge * edge)),
               radius * radius, PLD_SPREAD_TAIL * PLD_GAUSSIAN_REACH * spread,
               1.0f / max(PLD_IN_FRONT * layerZ, 1e-30f), level <= 2 ? PLD_SPREAD_FINE : PLD_SPREAD_COARSE, taps},
              sum);
  return gatheredFrom(sum);
}

PLD_CLONES void wideHalvedRow(GatherText& text, int level, int y, SpreadLevel& made) {
  for (int x = made.holding.x0; x < made.holding.x1; ++x) made.set(ivec2(x, y), text.halvedTexel(level, ivec2(x, y)));
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
