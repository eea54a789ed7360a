#pragma once
// What of a light reaches a place, between the texels of a light volume. Whoever includes this says where they come from:
//   vec3 visibilityTexel(int light, ivec3 texel)  [0,1]; clamped to the volume by the callee
#include "shared/lights.glsl"

struct Trilinear {
  ivec3 low;
  vec3 part;
};

//   at  in texels, a texel's centre at +0.5
PLD_FN Trilinear trilinearAt(vec3 at) {
  vec3 from = clamp(at, vec3(-1e6f), vec3(1e6f)) - vec3(0.5f);
  vec3 low = floor(from);
  Trilinear taps;
  taps.low = ivec3(int(low.x), int(low.y), int(low.z));
  taps.part = from - low;
  return taps;
}

PLD_FN float mixed(float a, float b, float part) {
  precise float value = a + (b - a) * part;
  return value;
}

PLD_FN vec3 mixed3(vec3 a, vec3 b, float part) {
  precise vec3 value = a + (b - a) * part;
  return value;
}

PLD_FN vec3 visibilityAt(int light, vec3 at) {
  Trilinear t = trilinearAt(at);
  vec3 a = mixed3(visibilityTexel(light, t.low), visibilityTexel(light, t.low + ivec3(1, 0, 0)), t.part.x);
  vec3 b = mixed3(visibilityTexel(light, t.low + ivec3(0, 1, 0)), visibilityTexel(light, t.low + ivec3(1, 1, 0)), t.part.x);
  vec3 c = mixed3(visibilityTexel(light, t.low + ivec3(0, 0, 1)), visibilityTexel(light, t.low + ivec3(1, 0, 1)), t.part.x);
  vec3 d = mixed3(visibilityTexel(light, t.low + ivec3(0, 1, 1)), visibilityTexel(light, t.low + ivec3(1, 1, 1)), t.part.x);
  return mixed3(mixed3(a, b, t.part.y), mixed3(c, d, t.part.y), t.part.z);
}
