#pragma once
// How the texels of a drawn shadow map become those of a prefiltered one: a tent in both dimensions, a quarter of the
// resolution. PT17 section 5, MODEL section 6
#include "shared/hash.glsl"
#include "shared/shadow_map.glsl"

const int PLD_SHADOW_TENT_REACH = 7;  // texels on either side of a tent's middle
const int PLD_SHADOW_DIVIDE = 4;      // prefiltered maps keep one texel of so many, in both dimensions

// The drawn texel in the middle of the tent of a kept one; the rows and columns of a map are filtered one after the other.
PLD_FN int tentMiddle(int kept) {
  return PLD_SHADOW_DIVIDE * kept + PLD_SHADOW_DIVIDE / 2;
}

// One texel of the 15, in the order of i from -7 to 7; those beyond the face are left out.
PLD_FN vec4 addToTent(vec4 sum, int i, vec4 texel) {
  precise vec4 weighted = shadowTent(i) * texel;
  precise vec4 result = sum + weighted;
  return result;
}

// Of one face of one light: what its casters' coins hang on.
PLD_FN uint mapSeedOf(uint seed, uint light, uint face) {
  return hashOf(seed ^ hashOf(0x5badu + light)) + face;
}
