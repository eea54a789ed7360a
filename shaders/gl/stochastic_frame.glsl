#pragma once
// What the passes of stochastic transparency know of their samples. Mirrors StochasticFrameBlock in
// engine_bridge/gl/stochastic_draw.cpp.
#include "shared/stochastic_mask.glsl"

layout(std140, binding = 3) uniform StochasticFrame {
  uvec4 samples;  // S of a pixel; first and step of those of this pass; how many they are
  uvec4 choice;   // seed; 1 stratified; 1 for winners alone; 1 where identities are pieces
  ivec4 origin;   // display coordinates of the targets' top left pixel
} stochastic;

// Per pixel of the band, channel and sample of this pass: bits of the nearest depth; the owner among equals.
layout(std430, binding = 3) buffer SampleDepths { uint sampleDepths[]; };
#ifdef WINNERS
layout(std430, binding = 4) buffer SampleOwners { uint sampleOwners[]; };
#endif
layout(binding = 16) uniform usamplerBuffer maskRanks;  // 13 is the light of particles, of another type

#ifdef GREY
const int kSampleChannels = 1;
#else
const int kSampleChannels = 3;
#endif

struct Coin {
  uint key, identity;
  int place;  // of the pixel's first sample
};

Coin coinAt(ivec2 pixel, uint identity) {
  Coin coin;
  coin.identity = identity;
  uvec2 where = stochastic.choice.w == 0u ? uvec2(pixel + stochastic.origin.xy) : uvec2(0u);
  coin.key = coinKeyOf(where, identity, stochastic.choice.x);
  ivec2 inBand = pixel - band.xy;
  coin.place = (inBand.y * band.z + inBand.x) * kSampleChannels * int(stochastic.samples.w);
  return coin;
}

// Whether a fragment of this opacity covers sample k of this pass; `covered` is coveredCount() where stratified.
bool coversSample(Coin coin, float opacity, uint covered, uint k) {
  uint s = stochastic.samples.y + k * stochastic.samples.z;
  if (stochastic.choice.y == 0u) return coinCovers(opacity, coin.key, s);
  return covered > 0u && texelFetch(maskRanks, int(maskPlace(coin.key, s, stochastic.samples.x))).r < covered;
}

int samplePlace(Coin coin, int channel, uint k) { return coin.place + channel * int(stochastic.samples.w) + int(k); }
