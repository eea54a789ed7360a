#pragma once
// The opaque pixels beside a rim, and what they say of its occlusion. Whoever includes this says what stands there:
//   vec2 occluderAt(ivec2 pixel)  r planar z, +inf for nothing; g occlusion, which may be anything
//   ivec2 occludersSize()
#include "shared/occlusion.glsl"

float neighboursOcclusion(vec2 gradient, float z, ivec2 pixel, int form) {
  ivec2 size = occludersSize();
  OcclusionSearch search = occlusionSearch(gradient);
  precise vec2 sum = vec2(0.0f);
  for (int tap = 0; tap < search.taps; ++tap) {
    vec2 found = occluderAt(occlusionPixel(pixel, search, tap, form, size));
    if (!(abs(found.g) <= 3e38f) || !(found.r > 0.0f)) continue;  // it says nothing
    sum = sum + occlusionTap(search, tap, clamp(found.g, 0.0f, 1.0f), found.r, z, form);
  }
  return occlusionFrom(sum, form);
}
