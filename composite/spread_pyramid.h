// The levels of shaders/shared/spread_pyramid.glsl in memory.
#pragma once
#include <vector>

#include "gbuffer/image.h"
#include "shaders/spread_pyramid.h"

namespace pellucid {
// Texels lie from -PLD_SPREAD_MARGIN: beyond, a clamped picture repeats them exactly.
struct SpreadLevel {
  int width = 0, height = 0;  // of the picture's part
  Image<shading::SpreadTexel> texels;

  SpreadLevel(int w, int h)
      : width(w), height(h), texels(w + 2 * shading::PLD_SPREAD_MARGIN, h + 2 * shading::PLD_SPREAD_MARGIN) {}
  const shading::SpreadTexel& clamped(glm::ivec2 texel) const {
    const glm::ivec2 margin(shading::PLD_SPREAD_MARGIN);
    const glm::ivec2 place = glm::clamp(texel + margin, glm::ivec2(0), glm::ivec2(texels.width(), texels.height()) - 1);
    return texels.at(place.x, place.y);
  }
};

}  // namespace pellucid
