// The levels of shaders/shared/spread_pyramid.glsl in memory.
#pragma once
#include <algorithm>
#include <limits>

#include "gbuffer/image.h"
#include "shaders/spread_pyramid_text.h"

namespace pellucid::shading {

// Texels lie from -PLD_SPREAD_MARGIN to the level's size and PLD_SPREAD_MARGIN: beyond, a clamped picture repeats them
// exactly. Those of `holding` alone may hold something that diffuses; `stored` are in memory, which are the same and,
// at borders of the picture, as many of the repeated ones as a kernel reaches.
struct SpreadLevel {
  int width, height;  // of the picture's part
  Window holding, stored;
  Image<SpreadTexel> texels;  // of `stored`
  // Of the texels' bodies, for a look at many of them: -1 and +inf where nothing diffuses. Wider than `stored` by
  // kBeyond.
  Image<float> leastReach, mostRate;
  static constexpr int kBeyond = 8;
  static constexpr int kRepeated = PLD_SPREAD_TAPS / 2;

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
    texels = Image<SpreadTexel>(stored.width(), stored.height());
    leastReach = Image<float>(stored.width() + kBeyond, stored.height());
    mostRate = leastReach;
  }
  // Of a texel wherever it lies.
  const SpreadTexel& clamped(ivec2 texel) const {
    constexpr int margin = PLD_SPREAD_MARGIN;
    const int x = std::clamp(texel.x, -margin, width + margin - 1);
    const int y = std::clamp(texel.y, -margin, height + margin - 1);
    if (x < holding.x0 || y < holding.y0 || x >= holding.x1 || y >= holding.y1) return nothing();
    return texels.at(x - stored.x0, y - stored.y0);
  }
  // A texel of `holding`.
  void set(ivec2 texel, const SpreadTexel& value) {
    const int x = texel.x - stored.x0, y = texel.y - stored.y0;
    texels.at(x, y) = value;
    const bool any = value.body.mass > 0.0f;
    leastReach.at(x, y) = any ? value.body.leastReach : -1.0f;
    mostRate.at(x, y) = any ? value.body.mostRate : std::numeric_limits<float>::infinity();
  }
  // After all of `holding`: the texels that repeat them.
  void repeat() {
    for (int y = stored.y0; y < stored.y1; ++y)
      for (int x = stored.x0; x < stored.x1; ++x) {
        const ivec2 own(std::clamp(x, holding.x0, holding.x1 - 1), std::clamp(y, holding.y0, holding.y1 - 1));
        if (own.x != x || own.y != y) set(ivec2(x, y), texels.at(own.x - stored.x0, own.y - stored.y0));
      }
  }

 private:
  static const SpreadTexel& nothing() {
    static const SpreadTexel empty = emptySpreadTexel();
    return empty;
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
