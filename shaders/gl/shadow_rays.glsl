#pragma once
// What rays have found of the lights at the pixel's fragments. After gl/frame.glsl; filled in by
// engine_bridge/gl/shadow_ray_table.h.
#include "shared/hash.glsl"

// A texel per pixel: place of its first fragment, their number. Then of each fragment its identity and depth, and a
// texel per light: bits of what of it arrives.
layout(binding = 12) uniform usamplerBuffer tracedLight;

// Where a fragment's lights begin, -1 where none were traced.
int tracedPlace(ivec2 pixel, uint identity, float z, int lights) {
  uvec4 range = texelFetch(tracedLight, pixel.y * int(viewport.x) + pixel.x);
  int place = -1;
  float nearest = 0.0f;
  for (uint i = 0u; i < range.y; ++i) {
    int at = int(range.x + i * uint(1 + lights));
    uvec4 fragment = texelFetch(tracedLight, at);
    float apart = abs(uintBitsToFloat(fragment.y) - z);
    // Two triangles of one identity are one in 4 thousand millions; then the depth tells.
    if (fragment.x != identity || (place >= 0 && apart >= nearest)) continue;
    place = at + 1;
    nearest = apart;
  }
  return place;
}

vec3 tracedVisibility(int place, int light) {
  if (place < 0) return vec3(1.0f);
  return uintBitsToFloat(texelFetch(tracedLight, place + light).rgb);
}
