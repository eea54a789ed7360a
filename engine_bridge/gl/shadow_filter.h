// Texels of shadow maps from what a face's passes have drawn, band by band.
#pragma once
#include <vector>

#include "gbuffer/image.h"
#include "shaders/shadow_map.h"

namespace pellucid::gl {

constexpr int kTentReach = shading::PLD_SHADOW_TENT_REACH;
constexpr int kShadowDivide = shading::PLD_SHADOW_DIVIDE;

// Of a band as drawn: nearest depth and optical depth per channel, `steps` in alpha of `nearest` for one channel.
struct DrawnBand {
  Image<glm::vec4> nearest, steps;  // steps empty for one channel
};

// Unfiltered texels of a band.
void shadowTexels(const DrawnBand& band, int channels, glm::vec4* out);

// Tent-filtered texels at a quarter of the resolution. Texel X has its tent's middle on drawn texel 4 X + 2; beyond the
// face nothing is drawn.
//   band     of the face's rows from firstRow - kTentReach, as many as its image has
//   edge     of the face as drawn
//   rows     of the result, each of edge / 4 texels
//   weights  of these: 1, less where some of the drawn texels hold nothing but what light does not come to
void filterShadow(const DrawnBand& band, int channels, int edge, int rows, glm::vec4* out, float* weights);

// Texels of a whole face to which light does not come at all take what those around them hold, so that a lookup between
// both finds no light there either.
void fillStopped(const std::vector<float>& weights, int channels, int edge, glm::vec4* texels);

}  // namespace pellucid::gl
