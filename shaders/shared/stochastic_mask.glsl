#pragma once
// Stratified masks from a table of random orders: a mask of R samples is a run of R ranks of one order, so masks of
// different R nest. ST10 section 5 keeps as many masks for each alpha.
#include "shared/stochastic.glsl"

const uint PLD_MASK_ROW_BITS = 11u;  // orders in the table, as a power of two

// Where in the table the rank of sample s stands, in the order that `key` picks, turned by any of S offsets.
//   samples  S, the length of a row
PLD_FN uint maskPlace(uint key, uint s, uint samples) {
  uint bits = hashOf(key ^ 0x85ebca6bu);
  uint row = bits & ((1u << PLD_MASK_ROW_BITS) - 1u);
  uint turned = s + (bits >> PLD_MASK_ROW_BITS) % samples;
  return row * samples + (turned < samples ? turned : turned - samples);
}

// Sums of floats that no order may change are kept in whole steps: at most this many in all.
const float PLD_SUM_STEPS = 8388608.0f;

// A step for `count` values that none exceeds `most`.
PLD_FN float sumStep(float most, float count) {
  precise float step_ = most * count * (1.0f / PLD_SUM_STEPS);
  return step_;
}

// A value in steps, rounded up or down at random: right on the average.
PLD_FN float stepsOf(float value, float step_, uint xi24) {
  if (!(step_ > 0.0f)) return 0.0f;
  precise float steps = value / step_ + float(xi24) * (1.0f / float(PLD_COIN_ONE));
  return floor(steps);
}
