// The levels of shaders/shared/spread_pyramid.glsl in memory.
#pragma once
#include <algorithm>
#include <cstring>
#include <limits>

#include "composite/columns.h"
#include "shaders/spread_pyramid_text.h"

namespace pellucid::shading {

// The numbers of a texel, each a plane of its own.
enum SpreadPlane {
  kSpreadColour,  // and the three after it
  kSpreadMass = 4,
  kLeastReach,
  kMostReach,
  kLeastRate,
  kMostRate,
  kReachColour,
  kRateColour = kReachColour + 4,
  kReachMass = kRateColour + 4,
  kRateMass,
  kSpreadPlanes
};
static_assert(kLeastReach == kSpreadMass + 1 && kMostRate == kLeastReach + 3);
constexpr int kSpreadSums = kSpreadMass + 1;  // what a kernel adds up
static_assert(sizeof(SpreadTexel) == kSpreadPlanes * sizeof(float) &&
              sizeof(SpreadBody) == kReachColour * sizeof(float));

// Texels lie from -PLD_SPREAD_MARGIN to the level's size and PLD_SPREAD_MARGIN: beyond, a clamped picture repeats them
// exactly. Those of `holding` alone may hold something that diffuses; `stored` are in memory, which are the same and,
// at borders of the picture, as many of the repeated ones as a kernel reaches.
struct SpreadLevel {
  int width, height;  // of the picture's part
  Window holding, stored;
  Columns texels;  // of `stored`, by SpreadPlane
  // Of the texels of a block that hold something; where nothing is, numbers that no comparison finds.
  struct Extremes {
    float leastReach = std::numeric_limits<float>::infinity(), mostReach = -leastReach;
    float leastRate = leastReach, mostRate = -leastReach;
    void join(const Extremes& other) {
      leastReach = std::min(leastReach, other.leastReach);
      mostReach = std::max(mostReach, other.mostReach);
      leastRate = std::min(leastRate, other.leastRate);
      mostRate = std::max(mostRate, other.mostRate);
    }
  };
  Image<Extremes> blocks;  // of kBlock x kBlock texels, from the first of `stored` on
  static constexpr int kRepeated = PLD_SPREAD_TAPS / 2, kBlock = 8;

  //   below  the pixels that diffuse, or `holding` of the level before
  SpreadLevel(int level, int pictureWidth, int pictureHeight, const Window& below)
      : width(sizeOf(level, pictureWidth)), height(sizeOf(level, pictureHeight)) {
    const int least = level == 1 ? 0 : -PLD_SPREAD_MARGIN;
    const int mostX = level == 1 ? pictureWidth : sizeOf(level - 1, pictureWidth) + PLD_SPREAD_MARGIN;
    const int mostY = level == 1 ? pictureHeight : sizeOf(level - 1, pictureHeight) + PLD_SPREAD_MARGIN;
    holding = {firstOf(below.x0, least), firstOf(below.y0, least), endOf(below.x1, mostX, width),
               endOf(below.y1, mostY, height)};
    stored = holding;
    if (stored.x0 == -PLD_SPREAD_MARGIN) stored.x0 -= kRepeated;
    if (stored.y0 == -PLD_SPREAD_MARGIN) stored.y0 -= kRepeated;
    if (stored.x1 == width + PLD_SPREAD_MARGIN) stored.x1 += kRepeated;
    if (stored.y1 == height + PLD_SPREAD_MARGIN) stored.y1 += kRepeated;
    texels = Columns(stored, kSpreadPlanes, 0.0f);
    const int across = (stored.width() + kBlock - 1) / kBlock, down = (stored.height() + kBlock - 1) / kBlock;
    blocks = Image<Extremes>(across, down);
  }
  // Of a texel wherever it lies.
  SpreadTexel clamped(ivec2 texel) const { return read<SpreadTexel>(texel); }
  SpreadBody clampedBody(ivec2 texel) const { return read<SpreadBody>(texel); }
  // A texel of `stored`.
  void set(ivec2 texel, const SpreadTexel& value) {
    float numbers[kSpreadPlanes];
    std::memcpy(numbers, &value, sizeof value);
    for (int k = 0; k < kSpreadPlanes; ++k) *texels.at(k, texel.x, texel.y) = numbers[k];
  }
  // After all of `holding`: the texels that repeat them.
  void repeat() {
    for (int y = stored.y0; y < stored.y1; ++y)
      for (int x = stored.x0; x < stored.x1; ++x) {
        const ivec2 own(std::clamp(x, holding.x0, holding.x1 - 1), std::clamp(y, holding.y0, holding.y1 - 1));
        if (own.y == y && own.x == x) x = holding.x1;  // between them lie the texels that are there
        if (x < stored.x1) set(ivec2(x, y), clamped(ivec2(std::clamp(x, holding.x0, holding.x1 - 1), own.y)));
      }
  }
  // After all of `stored`: a column of blocks.
  void summarise(int block) {
    const int first = stored.x0 + block * kBlock;
    for (int x = first; x < std::min(first + kBlock, stored.x1); ++x) {
      const float* mass = texels.at(kSpreadMass, x, stored.y0);
      const std::size_t plane = texels.planeStride();
      for (int i = 0; i < stored.height(); ++i) {
        if (!(mass[i] > 0.0f)) continue;
        const float* reach = mass + i + plane;  // and the planes behind it
        blocks.at(block, i / kBlock).join({reach[0], reach[plane], reach[2 * plane], reach[3 * plane]});
      }
    }
  }

 private:
  template <class Texel>
  Texel read(ivec2 texel) const {
    constexpr int margin = PLD_SPREAD_MARGIN;
    const int x = std::clamp(texel.x, -margin, width + margin - 1);
    const int y = std::clamp(texel.y, -margin, height + margin - 1);
    Texel result;
    if (x < holding.x0 || y < holding.y0 || x >= holding.x1 || y >= holding.y1) {
      const SpreadTexel nothing = emptySpreadTexel();
      std::memcpy(&result, &nothing, sizeof result);
      return result;
    }
    float numbers[sizeof(Texel) / sizeof(float)];
    int k = 0;
    for (float& number : numbers) number = *texels.at(k++, x, y);
    std::memcpy(&result, numbers, sizeof result);
    return result;
  }
  static int sizeOf(int level, int size) { return (size + (1 << level) - 1) >> level; }
  // A texel t reads those from 2t - 1 to 2t + 2 below it.
  static int firstOf(int below, int least) {
    return below <= least ? -PLD_SPREAD_MARGIN : std::max(-PLD_SPREAD_MARGIN, (below - 1) >> 1);
  }
  static int endOf(int below, int most, int size) {
    const int end = size + PLD_SPREAD_MARGIN;
    return below >= most ? end : std::min(end, (below >> 1) + 1);
  }
};

}  // namespace pellucid::shading
