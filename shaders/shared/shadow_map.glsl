#pragma once
// Stochastic shadow maps: what a caster leaves in a texel, and what a texel says about a depth. Enderton et al. 2010
// sections 3.2 and 3.6 (ST10); PT17 section 5; MODEL section 6.
#include "shared/scattering.glsl"
#include "shared/shadow.glsl"
#include "shared/stochastic.glsl"
#include "shared/surface.glsl"

const float PLD_SHADOW_NOTHING = 1e30f;  // the depth of a texel without a caster
const float PLD_SHADOW_STEPS = 4096.0f;  // optical depths are summed in whole steps of 1 over this

// Of filtered depths, in the map's units: its casters' extent is about 1 to 2. Below it lie the rounding of z^2 in
// float and the contact of a caster with what it stands on.
const float PLD_SHADOW_LEAST_VARIANCE = 1e-6f;

// rho of one caster, per channel.
//   cosLight  |cosine| between its normal and the direction to the light, [0,1]
PLD_FN vec3 casterDensity(Surface surface, float cosLight, float eta) {
  return shadowDensity(opacityOf(surface.coverage, transmissionAt(surface, cosLight)), cosLight, eta);
}

// One caster's random numbers in one map: the noise belongs to the geometry.
PLD_FN uint casterKeyOf(uint identity, uint mapSeed) {
  return hashOf(identity ^ hashOf(mapSeed));
}

// xi of a texel, 24 bits, stratified over the 2x2, 4x4, ... 16x16 texels around it: of every such square, rho of the
// texels lie below rho, rounded up or down. Digit by digit, base 4: each cell of a quadtree turns an ordered dither by
// random bits of its own. One texel's xi is uniform, and independent of other casters'.
PLD_FN uint stratifiedXi(uvec2 texel, uint key) {
  uint x = texel.x;
  uint y = texel.y;
  uint xi = 0u;
  for (uint level = 0u; level < 4u; ++level) {
    uint place = (((x ^ y) & 1u) << 1u) | (y & 1u);
    x >>= 1u;
    y >>= 1u;
    uint cell = (x * 0x9e3779b9u) ^ (y * 0x85ebca6bu) ^ ((xi * 4u + level) * 0xc2b2ae35u);
    xi = (xi << 2u) | (place ^ (hashOf(key ^ cell) & 3u));
  }
  uint rest = hashOf(key ^ hashOf(texel.x ^ hashOf(texel.y))) >> 16u;
  return (xi << 16u) | rest;
}

PLD_FN uint naiveXi(uvec2 texel, uint key) {
  return hashOf(key ^ hashOf(texel.x ^ hashOf(texel.y))) >> 8u;
}

// Whether a caster of this rho is in the texel. One xi decides all three channels: grey stays grey.
PLD_FN bool casts(float rho, uint xi) {
  return xi < coinWeight(rho);
}

// Optical depth of rho in whole steps, rounded up or down at random: sums of these are exact in float in any order, and
// right on the average.
PLD_FN float steppedDepth(float rho, uint xi) {
  precise float steps = opticalDepth(rho, 1.0f - rho) * PLD_SHADOW_STEPS + float(xi) * (1.0f / float(PLD_COIN_ONE));
  return floor(steps);
}

// One channel of an unfiltered texel; sums of such texels are what a map holds.
//   nearest  of the casters that the coins left, PLD_SHADOW_NOTHING for none
//   steps    sum of steppedDepth() over all casters
// Returns what all casters hide, 1 if there is one, its depth, and that squared.
PLD_FN vec4 shadowTexelOf(float nearest, float steps) {
  float hidden = pldOneMinusExp(steps * (1.0f / PLD_SHADOW_STEPS));
  if (nearest >= PLD_SHADOW_NOTHING) return vec4(hidden, 0.0f, 0.0f, 0.0f);
  precise float squared = nearest * nearest;
  return vec4(hidden, 1.0f, nearest, squared);
}

// The tent that prefilters, over 15 texels: i in [-7, 7]. Sums to 1.
PLD_FN float shadowTent(int i) {
  return float(8 - (i < 0 ? -i : i)) * (1.0f / 64.0f);
}

// At least so much of the casters' shadow falls on a receiver at `depth`: Chebyshev's one-sided bound on the casters that
// lie before it. With empty texels taken to lie at the receiver, as PT17 fills them, the bound on all texels is
// 1 - hit * this, the same number; so no depth needs to be invented for them.
//   texel  filtered, of one channel
PLD_FN float casterShare(vec4 texel, float depth) {
  if (!(texel.y > 0.0f)) return 1.0f;
  precise float mean = texel.z / texel.y;
  precise float variance = max(texel.w / texel.y - mean * mean, PLD_SHADOW_LEAST_VARIANCE);
  precise float behind = max(depth - mean, 0.0f);
  precise float squared = behind * behind;
  return squared / (variance + squared);
}

// The share itself, if the casters filled a slab of their mean and variance evenly. In smoke of optical depth 1 to 5
// this is off by .03 to .05, the bound by .25 to .3.
PLD_FN float slabShare(vec4 texel, float depth) {
  if (!(texel.y > 0.0f)) return 1.0f;
  precise float mean = texel.z / texel.y;
  precise float variance = max(texel.w / texel.y - mean * mean, PLD_SHADOW_LEAST_VARIANCE);
  precise float reach = sqrt(3.0f * variance);
  return clamp((depth - mean + reach) / (2.0f * reach), 0.0f, 1.0f);
}

// Where that slab begins: nothing casts before it.
PLD_FN float slabBegin(vec4 texel) {
  precise float mean = texel.z / texel.y;
  precise float variance = max(texel.w / texel.y - mean * mean, PLD_SHADOW_LEAST_VARIANCE);
  precise float begin = mean - sqrt(3.0f * variance);
  return begin;
}

const int PLD_SHADOW_CHEBYSHEV = 0;  // variance shadow map: one bilinear lookup, bounded as PT17 has it
const int PLD_SHADOW_CLOSER = 1;     // percentage closer: a square of texels, each before or behind
const int PLD_SHADOW_SLAB = 2;       // one bilinear lookup, casters taken to fill a slab; scaled to the exact density

struct ShadowLight {
  vec4 metric;   // directional: depth = dot(xyz, p) + w; else the light's position, and 1 over the unit in metres
  ivec4 faces;   // first transparent face, their number, first opaque face, their number
  ivec4 lookup;  // PLD_SHADOW_*; 1 to scale to the exact net density; edge of the square; 1 unless directional
  vec4 bias;     // how far a receiver moves towards the light: x + y * depth for opaque casters, z + w * depth for others
};

struct ShadowFace {
  mat4 mapFromView;  // texels and w, from view space
  ivec4 extent;      // first texel, edge, channels (1 or 3), unused
  vec4 inner;        // least and greatest texel that belong to this face alone, on both axes; zw unused
};
