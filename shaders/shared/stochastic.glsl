#pragma once
// Stochastic transparency (ST10 section 3.1): which of a pixel's S samples a fragment covers. Integers decide, so every
// machine covers the same samples.
#include "shared/hash.glsl"

const uint PLD_COIN_ONE = 16777216u;  // probabilities in 24 bits: a float in [0,1] keeps all its bits above 2^-24

// One fragment's random numbers in one pixel; of a piece (shared/piece.glsl) always in pixel 0: its noise goes along.
PLD_FN uint coinKeyOf(uvec2 pixel, uint identity, uint seed) {
  return hashOf(identity ^ hashOf(pixel.x ^ hashOf(pixel.y ^ hashOf(seed))));
}

// A probability as a count out of PLD_COIN_ONE. One xi against it decides all three channels: grey stays grey.
PLD_FN uint coinWeight(float probability) {
  return uint(probability * float(PLD_COIN_ONE) + 0.5f);
}

// Naive masks: each sample flips its own coin.
PLD_FN bool coinCovers(float opacity, uint key, uint s) {
  return (hashOf(key + s) >> 8u) < coinWeight(opacity);
}

// Stratified masks: R = floor(o S + xi) samples of S.
//   samples  S, at most 4096, so that o S stays exact in 12 + 24 bits split as below
PLD_FN uint coveredCount(float opacity, uint samples, uint key) {
  uint xi = hashOf(key ^ 0x9e3779b9u) >> 8u;
  uint weight = coinWeight(opacity);
  // o S in 24-bit fixed point, whole and fraction apart: no product here exceeds 32 bits.
  uint high = (weight >> 12u) * samples;
  uint low = (weight & 4095u) * samples;
  uint whole = high >> 12u;
  uint fraction = ((high & 4095u) << 12u) + low;
  return whole + ((fraction + xi) >> 24u);
}
