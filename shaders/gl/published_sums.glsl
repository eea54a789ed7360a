#pragma once
// The targets of PT17 table 2, read back: what gbuffer/published.h does with them on the CPU.
#include "shared/published.glsl"

// Drivers may multiply by a rounded 1/255: the steps themselves are exact.
vec4 unormTexel(vec4 texel) {
  return vec4(fromUnorm(unormOf(texel.r)), fromUnorm(unormOf(texel.g)), fromUnorm(unormOf(texel.b)),
              fromUnorm(unormOf(texel.a)));
}

PublishedSums publishedAt(ivec2 pixel) {
  // Above the largest half the decoder knows a sum that was cut.
  vec4 radiance = min(texelFetch(radianceSum, pixel, 0), vec4(2.0f * PLD_HALF_LARGEST));
  vec4 beta = unormTexel(texelFetch(betaProduct, pixel, 0));
  vec2 offset = vec2(0.0f);
#ifdef SCATTER
  vec4 delta = texelFetch(deltaSum, pixel, 0);
  offset = vec2(fromSnorm(snormOf(delta.x)), fromSnorm(snormOf(delta.y)));
#endif
  return unpackPublished(radiance, beta, offset);
}

// As sums of W delta, W, s^2: offsets are summed, not averaged.
vec4 publishedPath(PublishedSums sums) {
  bool bends = sums.offset.x != 0.0f || sums.offset.y != 0.0f;
  return vec4(sums.offset, bends ? 1.0f : 0.0f, sums.variance);
}

bool anyPublished(PublishedSums sums) {
  bool any = sums.denominator != 0.0f || sums.numerator != vec3(0.0f) || sums.beta != vec3(1.0f);
#ifdef SCATTER
  any = any || sums.offset != vec2(0.0f) || sums.variance > 0.0f;
#endif
  return any;
}
