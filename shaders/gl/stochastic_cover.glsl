#pragma once
// First pass: the nearest depth of each sample, what all fragments hide, and in what range the next pass adds.
#include "gl/stochastic_frame.glsl"
layout(location = 0) out vec4 reach;   // MAX: brightest channel, minus the depth
layout(location = 1) out vec4 depths;  // adds: optical depth in steps, fragments

const float kDepthSteps = 65536.0f;

void coverSamples(Layer layer, uint identity, ivec2 pixel) {
  Coin coin = coinAt(pixel, identity);
  vec3 o = opacityOf(layer.coverage, layer.transmission);
  uint bits = floatBitsToUint(layer.z);
  for (int c = 0; c < kSampleChannels; ++c) {
    uint covered = coveredCount(o[c], stochastic.samples.x, coin.key);
    for (uint k = 0u; k < stochastic.samples.w; ++k)
      if (coversSample(coin, o[c], covered, k)) atomicMin(sampleDepths[samplePlace(coin, c, k)], bits);
  }
  uint xi = hashOf(coin.key ^ 0xc2b2ae35u) >> 8u;
  vec3 tau = opticalDepth3(o, passedBy(layer.coverage, layer.transmission));
  vec3 steps = floor(tau * kDepthSteps + float(xi) * (1.0f / float(PLD_COIN_ONE)));
  depths = vec4(steps, 1.0f);
  vec3 bright = layer.radiance;
#ifdef WINNERS
  for (int c = 0; c < 3; ++c)
    if (coinWeight(o[c]) != 0u) bright[c] = max(bright[c], layer.radiance[c] / o[c]);
#endif
  reach = vec4(max(bright.r, max(bright.g, bright.b)), -layer.z, 0.0f, 0.0f);
}
