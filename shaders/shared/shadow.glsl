#pragma once
// What a transparent surface hides of a light: PT17 eqs. 11-13, as MODEL section 6 settles them.
#include "shared/numeric.glsl"

// Strength s of the caustic, [0,1]. Eq. 11
//   eta  index outside over index inside, > 0; from 1 up the surface focuses nothing
PLD_FN float causticStrength(float eta) {
  precise float s = (1.0f / eta - 1.0f) * 0.5f;
  return clamp(s, 0.0f, 1.0f);
}

// rho, the part of the light hidden, per channel. Eqs. 12 and 13
//   hidden    alpha (1 - t), [0,1]
//   cosLight  |cosine| between the normal and the direction to the light, [0,1]
PLD_FN vec3 shadowDensity(vec3 hidden, float cosLight, float eta) {
  float s = causticStrength(eta);
  if (s <= 0.0f) return hidden;
  float power = cosLight > 0.0f ? pldPow(cosLight, 128.0f * s * s) : 0.0f;
  precise float g = 2.0f * clamp(1.0f - power, 0.0f, 1.0f) - 1.0f;
  precise float gain = 1.0f + g * pldPow(s, 0.2f);
  precise vec3 rho = max(gain, 0.0f) * hidden;
  return min(rho, vec3(1.0f));
}
