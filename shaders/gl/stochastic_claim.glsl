#pragma once
// Between the passes, where only winners count: of the fragments at a sample's nearest depth, the least identity owns
// it.
#include "gl/stochastic_frame.glsl"

void claimSamples(Layer layer, uint identity, ivec2 pixel) {
  Coin coin = coinAt(pixel, identity);
  vec3 o = opacityOf(layer.coverage, layer.transmission);
  uint bits = floatBitsToUint(layer.z);
  for (int c = 0; c < kSampleChannels; ++c) {
    uint covered = coveredCount(o[c], stochastic.samples.x, coin.key);
    for (uint k = 0u; k < stochastic.samples.w; ++k) {
      int place = samplePlace(coin, c, k);
      if (sampleDepths[place] == bits && coversSample(coin, o[c], covered, k)) atomicMin(sampleOwners[place], identity);
    }
  }
}
