#include "composite/wide_pyramid.h"

#include <cmath>
#include <limits>

#include "composite/lanes.h"
#include "composite/wide_parts.h"

namespace pellucid::shading {

using lanes::Float8;
using lanes::Int8;
using lanes::kLanes;
using lanes::LossySum;
using Gathered = GatherText::Gathered;

namespace {

const Float8 kEight = {0, 1, 2, 3, 4, 5, 6, 7};
const Float8 kRight = {0, 0, 0, 0, 1, 1, 1, 1}, kDown = {0, 1, 2, 3, 0, 1, 2, 3};  // of TwoColumns
constexpr int kRoom = (PLD_SPREAD_TAPS + 2 * kLanes) / kLanes * kLanes;

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

void gaussianWeights(int first, int end, float place, float variance, float* weights) {
  for (int x = first; x < end; x += kLanes) {
    const Float8 d = kEight + float(x) + 0.5f - place;
    Float8 weight;
    lanes::expOf(-0.5f * (d * d) / variance, weight);
    lanes::store(weight, weights + (x - first));
  }
}

// Which pixels of a first level's texel are seen: four rows of two columns.
inline void weighPixels(const PyramidTaps& of, int x, int y, Int8& seen) {
  const Columns& pixels = of.text.taps;
  const TwoColumns two{pixels.at(0, x, y), pixels.at(0, x + 1, y), pixels.planeStride()};
  Float8 variance, depth, root, away;
  two.load(kTapVariance, variance);
  two.load(kTapDepth, depth);
  const Float8 dx = kRight + float(x) + 0.5f - of.centre.x, dy = kDown + float(y) + 0.5f - of.centre.y;
  lanes::rootOf(dx * dx + dy * dy, away);
  lanes::rootOf(variance, root);
  const Float8 reach = PLD_GAUSSIAN_REACH * root;
  const Float8 rate = 1.0f / (depth < 1e-30f ? Float8{} + 1e-30f : depth);
  seen = (variance > 0.0f) & ~(rate > of.rateLimit) & ~(reach < away);
}

// What is seen of four rows of two columns of the level below.
inline void weighTexels(const PyramidTaps& of, int x, int y, Int8& seen, Float8 (&parts)[kLanes]) {
  const Columns& below = of.text.spreadLevels[static_cast<std::size_t>(of.level - 2)].texels;
  const TwoColumns two{below.at(0, x, y), below.at(0, x + 1, y), below.planeStride()};
  const float edge = 0.5f * of.edge;
  const Float8 dx = (kRight + float(x) + 0.5f) * edge - of.centre.x,
               dy = (kDown + float(y) + 0.5f) * edge - of.centre.y;
  Float8 away, leastReach, mostRate, sums[kSpreadSums], passing[kSpreadSums];
  lanes::rootOf(dx * dx + dy * dy, away);
  two.load(kLeastReach, leastReach);
  two.load(kMostRate, mostRate);
  for (int k = 0; k < kSpreadSums; ++k) two.load(k, sums[k]);
  passingLanes(two, away, edge, of.rateLimit, passing);
  const Int8 inPart = (mostRate > of.rateLimit) | (leastReach < away + PLD_SPREAD_PARTS * edge);
  seen = sums[kSpreadMass] > 0.0f;
  for (int k = 0; k < kSpreadSums; ++k) sums[k] = inPart ? passing[k] : sums[k];
  lanes::byRows(sums, parts);
}

}  // namespace

// GatherText::passingParts, all of whose parts are stored.
PLD_CLONES void passingLanesOf(const PyramidTaps& of, ivec2 texel, Float8& sum) {
  const int x = 2 * texel.x - 1, y = 2 * texel.y - 1;
  Float8 parts[4][4];
  alignas(32) std::int32_t seen[2][kLanes];  // by columns
  for (int i = 0; i < 4; i += 2) {
    Int8 two;
    Float8 eight[kLanes];
    if (of.level == 1) {
      weighPixels(of, x + i, y, two);
      for (int k = 0; k < kLanes; ++k)
        lanes::loadFourAndOne(&of.text.backdrop.colour->at(x + i + k / 4, y + k % 4).r, eight[k]);
    } else {
      weighTexels(of, x + i, y, two, eight);
    }
    std::memcpy(seen[i / 2], &two, sizeof two);
    for (int k = 0; k < kLanes; ++k) parts[i + k / 4][k % 4] = eight[k];
  }
  sum = Float8{};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (seen[i / 2][4 * (i % 2) + j]) sum += spreadMask(i) * spreadMask(j) * parts[i][j];
}

namespace {

// GatherText::passingParts into a lane.
void takeApart(const PyramidTaps& of, ivec2 texel, int lane, float (&sums)[kSpreadSums][kLanes]) {
  const Columns& below =
      of.level == 1 ? of.text.taps : of.text.spreadLevels[static_cast<std::size_t>(of.level - 2)].texels;
  Float8 seen;
  if (below.holds(2 * texel.x - 1, 2 * texel.y - 1) && below.holds(2 * texel.x + 2, 2 * texel.y + 2)) {
    passingLanesOf(of, texel, seen);
  } else {
    const SpreadBody body = of.text.passingParts(of.level, texel, of.centre, of.rateLimit);
    seen = Float8{body.colour.r, body.colour.g, body.colour.b, body.colour.a, body.mass};
  }
  for (int k = 0; k < kSpreadSums; ++k) sums[k][lane] = seen[k];
}

// Eight texels of a column within reach.
struct ColumnTaps {
  int x, top;
  const float* down;  // weights of the rows
  float across;       // weight of the column
};

// Puts what is seen of texels in the place of those that are seen in part.
//   parts  which they are
//   away   from the centre to all texels', pixels
inline void seeParts(const PyramidTaps& of, const ColumnTaps& taps, const TexelLanes& texels, const Int8& parts,
                     const Float8& away, Float8 (&bodies)[kSpreadSums]) {
  Float8 seen[kSpreadSums], least, most, down;
  passingLanes(texels, away, of.edge, of.rateLimit, seen);
  for (int k = 0; k < kSpreadSums; ++k) bodies[k] = parts ? seen[k] : bodies[k];
  texels.load(kLeastReach, least);
  texels.load(kMostReach, most);
  lanes::load(taps.down, down);
  Int8 apart;
  cutLanes(least, most, away - PLD_SPREAD_PARTS * of.edge, away + PLD_SPREAD_PARTS * of.edge, apart);
  apart &= parts & ~(taps.across * down < of.fine);
  if (!lanes::anyOf(apart)) return;
  alignas(32) float sums[kSpreadSums][kLanes];
  for (int k = 0; k < kSpreadSums; ++k) lanes::store(bodies[k], sums[k]);
  for (int k = 0; k < kLanes; ++k)
    if (apart[k]) takeApart(of, ivec2(taps.x, taps.top + k), k, sums);
  for (int k = 0; k < kSpreadSums; ++k) lanes::load(sums[k], bodies[k]);
}

}  // namespace

// What of eight texels is seen, weighted, where some of them may be seen in part.
//   near  which lie within reach and hold something
PLD_CLONES void mixedColumn(const PyramidTaps& of, const ColumnTaps& taps, const Float8& r2, const Int8& near,
                            Float8 (&seen)[kSpreadSums]) {
  const TexelLanes texels{of.texels.texels.at(0, taps.x, taps.top), of.texels.texels.planeStride()};
  Float8 leastReach, mostReach, leastRate, mostRate, root;
  texels.load(kLeastReach, leastReach);
  texels.load(kMostReach, mostReach);
  texels.load(kLeastRate, leastRate);
  texels.load(kMostRate, mostRate);
  lanes::rootOf(r2, root);
  const Float8 away = of.edge * root;
  const Float8 behind = away + PLD_SPREAD_PARTS * of.edge, before = away - PLD_SPREAD_PARTS * of.edge;
  const Int8 whole = ~(mostRate > of.rateLimit) & ((leastReach >= of.tailReach) | (leastReach >= behind));
  const Int8 parts = near & ~whole & ~(leastRate > of.rateLimit) & ~(mostReach <= before);
  for (int k = 0; k < kSpreadSums; ++k) texels.load(k, seen[k]);
  if (lanes::anyOf(parts)) seeParts(of, taps, texels, parts, away, seen);
  const Float8 weight = near & (whole | parts) ? Float8{} + taps.across : Float8{};
  for (int k = 0; k < kSpreadSums; ++k) seen[k] *= weight;
}

namespace {

// What of some texels is seen where they lie within reach.
enum class Seen { nothing, whole, perhaps };

// How far the centre is from the nearest of the texels from x0 and y0 on, eight either way; less a part of a texel that
// no rounding makes up for.
inline float leastAway(const PyramidTaps& of, int x0, int y0) {
  const float left = float(x0) + 0.5f - of.place.x, right = of.place.x - (float(x0 + kLanes - 1) + 0.5f);
  const float above = float(y0) + 0.5f - of.place.y, below = of.place.y - (float(y0 + kLanes - 1) + 0.5f);
  const float dx = std::max({0.0f, left, right}), dy = std::max({0.0f, above, below});
  return std::sqrt(dx * dx + dy * dy) - 0.0625f;
}

// Of all texels of the rows from `top` on and of the columns of a block, within reach or not.
inline Seen seenOf(const PyramidTaps& of, int block, int top) {
  const SpreadLevel& level = of.texels;
  const int first = std::max(top - level.stored.y0, 0) / SpreadLevel::kBlock;
  const int last = std::min(top - level.stored.y0 + kLanes - 1, level.stored.height() - 1) / SpreadLevel::kBlock;
  SpreadLevel::Extremes all = level.blocks.at(block, first);
  all.join(level.blocks.at(block, last));
  if (!(all.leastRate <= of.rateLimit)) return Seen::nothing;
  if (all.mostRate <= of.rateLimit && all.leastReach >= of.tailReach) return Seen::whole;
  if (all.mostReach >= of.tailReach) return Seen::perhaps;  // seen from any distance, if all of a texel reaches as far
  const float away = leastAway(of, level.stored.x0 + block * SpreadLevel::kBlock, top);
  return all.mostReach <= (away - PLD_SPREAD_PARTS) * of.edge ? Seen::nothing : Seen::perhaps;
}

// Adds a column of eight texels that are seen whole to the sums of their rows.
//   dy2  squared distances from the centre; infinite where a row is none
inline void addWhole(const PyramidTaps& of, const ColumnTaps& taps, const Float8& dy2, Float8 (&rows)[kSpreadSums]) {
  const TexelLanes texels{of.texels.texels.at(0, taps.x, taps.top), of.texels.texels.planeStride()};
  const float dx = float(taps.x) + 0.5f - of.place.x;
  const Float8 weight = dx * dx + dy2 <= of.most2 ? Float8{} + taps.across : Float8{};
  for (int k = 0; k < kSpreadSums; ++k) {
    Float8 sums;
    texels.load(k, sums);
    rows[k] += weight * sums;
  }
}

// The same of those that are perhaps not.
inline void addColumn(const PyramidTaps& of, const ColumnTaps& taps, const Float8& dy2, Float8 (&rows)[kSpreadSums]) {
  const TexelLanes texels{of.texels.texels.at(0, taps.x, taps.top), of.texels.texels.planeStride()};
  const float dx = float(taps.x) + 0.5f - of.place.x;
  const Float8 r2 = dx * dx + dy2;
  Float8 mass, leastReach, mostRate, seen[kSpreadSums];
  texels.load(kSpreadMass, mass);
  texels.load(kLeastReach, leastReach);
  texels.load(kMostRate, mostRate);
  const Int8 near = (r2 <= of.most2) & (mass > 0.0f);
  if (!lanes::anyOf(near & ((mostRate > of.rateLimit) | ~(leastReach >= of.tailReach))))
    return addWhole(of, taps, dy2, rows);
  mixedColumn(of, taps, r2, near, seen);
  for (int k = 0; k < kSpreadSums; ++k) rows[k] += seen[k];
}

// Up to eight rows from `top` on.
inline void addPyramidRows(const PyramidTaps& of, int top, const float* across, const float* down,
                           Float8 (&rows)[kLanes]) {
  const Window& stored = of.texels.stored;
  if (top + kLanes <= stored.y0 || top >= stored.y1) return;
  // Beyond the circle no texel is seen; one is left for rounding.
  const float nearest =
      std::max(0.0f, std::max(float(top) + 0.5f - of.place.y, of.place.y - (float(top + kLanes - 1) + 0.5f)));
  const float half = std::sqrt(std::max(0.0f, of.most2 - nearest * nearest)) + 1.0f;
  const int begin = std::max({of.taps.x0, stored.x0, int(std::floor(of.place.x - 0.5f - half))});
  const int end = std::min({of.taps.x1, stored.x1, int(std::ceil(of.place.x - 0.5f + half)) + 1});
  const Float8 place = kEight + float(top);
  const Float8 dy = place + 0.5f - of.place.y;
  const Float8 dy2 = place < float(of.taps.y1) ? dy * dy : Float8{} + std::numeric_limits<float>::infinity();
  Float8 sums[kSpreadSums] = {};
  for (int x = begin; x < end;) {
    const int block = (x - stored.x0) / SpreadLevel::kBlock;
    const int next = std::min(end, stored.x0 + (block + 1) * SpreadLevel::kBlock);
    const Seen seen = seenOf(of, block, top);
    if (seen == Seen::whole)
      for (; x < next; ++x) addWhole(of, {x, top, down, across[x - of.taps.x0]}, dy2, sums);
    else if (seen == Seen::perhaps)
      for (; x < next; ++x) addColumn(of, {x, top, down, across[x - of.taps.x0]}, dy2, sums);
    x = next;
  }
  lanes::byRows(sums, rows);
}

}  // namespace

PLD_CLONES void pyramidRows(const PyramidTaps& of, Float8& result) {
  const Window& taps = of.taps;
  alignas(32) float across[kRoom], down[kRoom];
  gaussianWeights(taps.x0, taps.x1, of.place.x, of.weightVariance, across);
  gaussianWeights(taps.y0, taps.y1, of.place.y, of.weightVariance, down);
  LossySum sum;
  for (int top = taps.y0; top < taps.y1; top += kLanes) {
    Float8 rows[kLanes] = {};
    addPyramidRows(of, top, across, down + (top - taps.y0), rows);
    const int count = std::min(kLanes, taps.y1 - top);
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
  Gathered gathered{};
  gathered.colour = vec4(sum[0], sum[1], sum[2], sum[3]);
  gathered.weight = sum[4];
  return gathered;
}

PLD_CLONES void wideHalved(GatherText& text, int level, int x0, int x1, SpreadLevel& made) {
  for (int y = made.holding.y0; y < made.holding.y1; ++y)
    for (int x = x0; x < x1; ++x) made.set(ivec2(x, y), text.halvedTexel(level, ivec2(x, y)));
}

}  // namespace pellucid::shading
