// Drawn shadow texels to those that are looked up, all channels at once. FILTER 0: as they are; 1: across; 2: down,
// what 1 gave.
#include "shared/shadow_filter.glsl"

layout(binding = 0) uniform sampler2D first;  // FILTER 0 and 1: nearest; 2: the first channel
#ifndef GREY
layout(binding = 1) uniform sampler2D second;  // steps; the second channel
#if FILTER == 2
layout(binding = 2) uniform sampler2D third;
#endif
#endif

layout(location = 0) out vec4 red;
#ifndef GREY
layout(location = 1) out vec4 green;
layout(location = 2) out vec4 blue;
#endif

vec4 texelAt(ivec2 at, int channel) {
  vec4 texel = texelFetch(first, at, 0);
#if FILTER == 2
#ifndef GREY
  if (channel == 1) texel = texelFetch(second, at, 0);
  if (channel == 2) texel = texelFetch(third, at, 0);
#endif
  return texel;
#elif defined(GREY)
  return shadowTexelOf(texel.r, texel.a);
#else
  return shadowTexelOf(texel[channel], texelFetch(second, at, 0)[channel]);
#endif
}

vec4 texelHere(ivec2 at, int channel) {
#if FILTER == 0
  return texelAt(at, channel);
#else
  vec4 sum = vec4(0.0f);
  int middle = tentMiddle(FILTER == 1 ? at.x : at.y);
  int edge = textureSize(first, 0)[FILTER - 1];
  for (int i = -PLD_SHADOW_TENT_REACH; i <= PLD_SHADOW_TENT_REACH; ++i) {
    int from = middle + i;
    ivec2 place = FILTER == 1 ? ivec2(from, at.y) : ivec2(at.x, from);
    if (from >= 0 && from < edge) sum = addToTent(sum, i, texelAt(place, channel));
  }
  return sum;
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  red = texelHere(at, 0);
#ifndef GREY
  green = texelHere(at, 1);
  blue = texelHere(at, 2);
#endif
}
