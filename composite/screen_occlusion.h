// Ambient occlusion from depth alone, for pictures that bring none: horizons along a few directions of the screen, seen
// in the nearest pixels of blocks that grow with the distance, then a bilateral filter. Jimenez et al.: Practical
// Realtime Strategies for Accurate Indirect Occlusion, 2016. What depth does not show, the far side of things among it,
// counts as solid behind them.
#pragma once
#include <cstdint>

#include "gbuffer/camera.h"
#include "gbuffer/image.h"

namespace pellucid {

struct ScreenOcclusionSettings {
  double radius = 0.0;          // metres within which things hide the surroundings; 0 takes relativeRadius
  double relativeRadius = 0.1;  // of the pixel's own depth: the same on the screen at every scale
};

// Occlusion of a depth plane's pixels, [0,1], 1 = open; 1 where nothing was hit. Random turns come from the pixel's
// place, so that every run and thread count gives the same bits.
//   viewZ   planar metres, > 0, +inf where nothing was hit
//   wanted  pixels that matter; others are 1 and cost nothing. nullptr wants all
Image<float> screenOcclusion(const Image<float>& viewZ, const Camera& camera, const Window& display, const Window& data,
                             const ScreenOcclusionSettings& settings, const Image<std::uint8_t>* wanted = nullptr);

}  // namespace pellucid
