#pragma once
// One transparent surface sample: what it hides, how deep it is optically. MODEL: PS16 eq. 2.
#include "shared/numeric.glsl"

// Optical depth at which exp(-tau) is 0 in float; one opaque layer ends every sum here.
const float PLD_OPAQUE_DEPTH = 104.0f;
// Below this 1 - t a channel is clear: its light is added, not averaged. MODEL section 3.
const float PLD_CLEAR = 1e-3f;

// Part of the background one sample hides, per channel: o = coverage * (1 - transmission). [0,1]
//   coverage      part of the pixel it touches, [0,1]
//   transmission  colour let straight through where it touches, [0,1] per channel
PLD_FN vec3 opacityOf(float coverage, vec3 transmission) {
  precise vec3 hidden = coverage * (vec3(1.0f) - transmission);
  return hidden;
}

PLD_FN float meanOf(vec3 v) {
  precise float mean = (v.r + v.g + v.b) * 0.333333343f;
  return mean;
}

// What one sample lets through, per channel: 1 - o, but without its cancellation near o = 1. [0,1]
PLD_FN vec3 passedBy(float coverage, vec3 transmission) {
  precise vec3 passed = vec3(1.0f - coverage) + coverage * transmission;
  return passed;
}

// -ln(1 - o), capped, accurate at both ends.
//   opacity, passed  o and 1 - o, each with its own relative precision, [0,1]
PLD_FN float opticalDepth(float opacity, float passed) {
  // Thin layers by the series of their opacity, others by that of what passes: one series, one division.
  bool thin = opacity < 0.29f;
  BinaryParts parts = binaryParts(passed);
  precise float over = thin ? opacity : 1.0f - parts.mantissa;
  precise float under = thin ? 2.0f - opacity : 1.0f + parts.mantissa;
  precise float s = over / under;
  float depth = logOfParts(thin ? 0.0f : -parts.exponent, s);
  return passed <= 0.0f ? PLD_OPAQUE_DEPTH : clamp(depth, 0.0f, PLD_OPAQUE_DEPTH);
}

PLD_FN vec3 opticalDepth3(vec3 opacity, vec3 passed) {
  vec3 depth;
  depth.r = opticalDepth(opacity.r, passed.r);
  depth.g = opticalDepth(opacity.g, passed.g);
  depth.b = opticalDepth(opacity.b, passed.b);
  return depth;
}

// beta = exp(-tau): what is left of the background. PS16 eq. 2
PLD_FN vec3 transmittanceOf(vec3 depth) {
  vec3 beta;
  beta.r = pldExp(-depth.r);
  beta.g = pldExp(-depth.g);
  beta.b = pldExp(-depth.b);
  return beta;
}

// 1 - beta, without the cancellation.
//   beta  transmittanceOf(depth)
PLD_FN vec3 netOpacityOf(vec3 depth, vec3 beta) {
  vec3 net;
  net.r = pldOneMinusPower(depth.r, beta.r);
  net.g = pldOneMinusPower(depth.g, beta.g);
  net.b = pldOneMinusPower(depth.b, beta.b);
  return net;
}
