#pragma once
// One transparent fragment in a list. Mirrors Fragment in gbuffer/fragments.h, 48 bytes in std430.
#include "shared/hash.glsl"

struct FragmentRecord {
  vec3 radiance;
  float coverage;
  vec3 transmission;
  float z;
  vec2 offset;
  float variance;
  uint identity;
};
