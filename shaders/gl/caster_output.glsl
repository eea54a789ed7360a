#pragma once
// What a transparent caster leaves in a texel of a shadow map: the nearest depth by the coins, and what it hides.
#include "shared/shadow_filter.glsl"

layout(location = 0) out vec4 nearest;  // MIN; alpha adds
#ifndef GREY
layout(location = 1) out vec4 steps;    // adds
#endif

// A caster behind what is opaque leaves nothing but that there was one.
void writeCulled() {
#ifdef GREY
  nearest = vec4(PLD_SHADOW_NOTHING, PLD_SHADOW_NOTHING, -1.0f, 0.0f);
#else
  nearest = vec4(PLD_SHADOW_NOTHING, PLD_SHADOW_NOTHING, PLD_SHADOW_NOTHING, 0.0f);
  steps = vec4(0.0f, 0.0f, 0.0f, 1.0f);
#endif
}

//   rho    part of the light hidden, per channel
//   depth  the map's
//   key    casterKeyOf()
//   naive  one coin a texel, else stratified
void writeCaster(vec3 rho, float depth, uvec2 place, uint key, bool naive) {
  uint xi = naive ? naiveXi(place, key) : stratifiedXi(place, key);
  nearest.r = casts(rho.r, xi) ? depth : PLD_SHADOW_NOTHING;
  nearest.g = casts(rho.g, xi) ? depth : PLD_SHADOW_NOTHING;
  nearest.b = casts(rho.b, xi) ? depth : PLD_SHADOW_NOTHING;
  uint rounding = naiveXi(place, hashOf(key));
#ifdef GREY
  nearest.a = steppedDepth(rho.r, rounding);
#else
  nearest.a = 0.0f;
  steps = vec4(steppedDepth(rho.r, rounding), steppedDepth(rho.g, rounding), steppedDepth(rho.b, rounding), 0.0f);
#endif
}
