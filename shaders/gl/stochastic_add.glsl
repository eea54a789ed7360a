#pragma once
// Second pass: every fragment's light by the share of samples that see it, or that it won. ST10 eqs. 4 and 6. Mirrors
// samplePixel() in composite/methods/stochastic.cpp.
#include "gl/stochastic_frame.glsl"
layout(location = 0) out vec4 lightSteps;
layout(location = 1) out vec4 unitSteps;
layout(location = 2) out vec4 addedSteps;
layout(binding = 14) uniform sampler2D reachOf;
layout(binding = 15) uniform sampler2D depthsOf;

void addVisible(Layer layer, uint identity, ivec2 pixel) {
  Coin coin = coinAt(pixel, identity);
  vec3 o = opacityOf(layer.coverage, layer.transmission);
  uint bits = floatBitsToUint(layer.z);
  vec3 visible = vec3(0.0f), won = vec3(0.0f);
  for (int c = 0; c < kSampleChannels; ++c) {
#ifdef WINNERS
    uint covered = coveredCount(o[c], stochastic.samples.x, coin.key);
#endif
    for (uint k = 0u; k < stochastic.samples.w; ++k) {
      int place = samplePlace(coin, c, k);
      uint nearest = sampleDepths[place];
      visible[c] += bits <= nearest ? 1.0f : 0.0f;
#ifdef WINNERS
      bool owned = bits == nearest && sampleOwners[place] == identity;
      won[c] += owned && coversSample(coin, o[c], covered, k) ? 1.0f : 0.0f;
#endif
    }
  }
#ifdef GREY
  visible = vec3(visible.r);
  won = vec3(won.r);
#endif
  float share = 1.0f / float(stochastic.samples.w);
  vec3 light = vec3(0.0f), unit = vec3(0.0f), added = vec3(0.0f);
  for (int c = 0; c < 3; ++c) {
    if (isAdditive(layer.coverage, layer.transmission[c]) || coinWeight(o[c]) == 0u) {
      added[c] = visible[c] * share * layer.radiance[c];
#ifdef WINNERS
    } else if (won[c] > 0.0f) {
      light[c] = won[c] * share * layer.radiance[c] / o[c];
      unit[c] = won[c] * share;
#else
    } else {
      light[c] = visible[c] * share * layer.radiance[c];
      unit[c] = visible[c] * share * o[c];
#endif
    }
  }
  float count = texelFetch(depthsOf, pixel, 0).a;
  float most = texelFetch(reachOf, pixel, 0).r;
  uint xi = hashOf(coin.key ^ 0x27d4eb2fu) >> 8u;
  float lightStep = sumStep(most, count), unitStep = sumStep(1.0f, count);
  lightSteps =
      vec4(stepsOf(light.r, lightStep, xi), stepsOf(light.g, lightStep, xi), stepsOf(light.b, lightStep, xi), 0.0f);
  unitSteps = vec4(stepsOf(unit.r, unitStep, xi), stepsOf(unit.g, unitStep, xi), stepsOf(unit.b, unitStep, xi), 0.0f);
  addedSteps =
      vec4(stepsOf(added.r, lightStep, xi), stepsOf(added.g, lightStep, xi), stepsOf(added.b, lightStep, xi), 0.0f);
}
