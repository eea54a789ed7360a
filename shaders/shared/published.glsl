#pragma once
// The `published` tier: the targets of PT17 table 2, 112 bits a pixel, with encoder beside decoder. PT17 listings 1, 3
#include "shared/refraction.glsl"
#include "shared/resolve.glsl"

const float PLD_HALF_LARGEST = 65504.0f;
const float PLD_SCATTER_UNIT = 63.0f;              // pixels: the largest spread, and the largest offset on one axis
const float PLD_LEAST_SHARE = 1.0f / 256.0f;       // of PLD_SCATTER_UNIT^2: spread that is not 0 stays so in 8 bits
const float PLD_LEAST_DENOMINATOR = 1e-5f;

// What one layer writes. radiance, beta.a and delta add up; beta.rgb is multiplied: ZERO, ONE_MINUS_SRC_COLOR.
struct PublishedTargets {
  vec4 radiance;  // RGBA16F: w C, w o; o is the mean over channels
  vec4 beta;      // RGBA8: alpha (1 - t), s^2 / 63^2
  vec2 delta;     // RG8_SNORM: o delta / 63
  int clamped;    // how many of these numbers do not fit
};

// What the targets of a pixel say once all layers are in.
struct PublishedSums {
  vec3 numerator;
  float denominator;
  vec3 beta;
  float variance;  // D^2, float pixels^2
  vec2 offset;     // sum of o delta, float pixels, y down
};

// The nearest half, ties to even, as a float; beyond the largest half, infinity.
PLD_FN float roundedToHalf(float x) {
  float size = abs(x);
  if (size >= 65520.0f) return x < 0.0f ? -intBitsToFloat(0x7f800000) : intBitsToFloat(0x7f800000);
  precise float result = size;
  if (size < 6.103515625e-5f) {
    // Below the normal halves the step is 2^-24, which is float's own just above a half.
    result = (size + 0.5f) - 0.5f;
  } else {
    int bits = floatBitsToInt(size);
    result = intBitsToFloat((bits + 0x0fff + ((bits >> 13) & 1)) & ~0x1fff);
  }
  return x < 0.0f ? -result : result;
}

// [0,1] to one of 256 steps, and back.
PLD_FN int unormOf(float x) {
  precise float scaled = clamp(x, 0.0f, 1.0f) * 255.0f;
  return int(floor(scaled + 0.5f));
}
PLD_FN float fromUnorm(int steps) {
  precise float x = float(steps) / 255.0f;
  return x;
}

// [-1,1] to one of 255 steps, and back.
PLD_FN int snormOf(float x) {
  precise float scaled = clamp(x, -1.0f, 1.0f) * 127.0f;
  return int(floor(scaled + 0.5f));
}
PLD_FN float fromSnorm(int steps) {
  precise float x = float(steps) / 127.0f;
  return max(x, -1.0f);
}

//   numerator, denominator  w C and w o, o being the mean over channels
//   o                       opacity per channel
PLD_FN PublishedTargets publishedTargets(vec3 numerator, float denominator, vec3 o, Scatter scatter) {
  precise float share = scatter.variance / (PLD_SCATTER_UNIT * PLD_SCATTER_UNIT);
  precise vec2 delta = (meanOf(o) / PLD_SCATTER_UNIT) * scatter.offset;
  if (scatter.variance > 0.0f) share = max(share, PLD_LEAST_SHARE);
  int clamped = 0;
  if (numerator.r > PLD_HALF_LARGEST) clamped += 1;
  if (numerator.g > PLD_HALF_LARGEST) clamped += 1;
  if (numerator.b > PLD_HALF_LARGEST) clamped += 1;
  if (denominator > PLD_HALF_LARGEST) clamped += 1;
  if (share > 1.0f) clamped += 1;
  if (abs(delta.x) > 1.0f) clamped += 1;
  if (abs(delta.y) > 1.0f) clamped += 1;
  PublishedTargets targets;
  targets.radiance = vec4(min(numerator, vec3(PLD_HALF_LARGEST)), min(denominator, PLD_HALF_LARGEST));
  targets.beta = vec4(o, min(share, 1.0f));
  targets.delta = clamp(delta, vec2(-1.0f), vec2(1.0f));
  targets.clamped = clamped;
  return targets;
}

PLD_FN PublishedTargets packPublished(Layer layer, Scatter scatter, WeightSettings settings) {
  vec3 o = opacityOf(layer.coverage, layer.transmission);
  float netOpacity = meanOf(o);
  float w = layerWeight(settings, layer.z, netOpacity);
  precise vec3 numerator = w * layer.radiance;
  precise float denominator = w * netOpacity;
  return publishedTargets(numerator, denominator, o, scatter);
}

//   radiance, beta, delta  as texture reads return them: beta.rgb is the product of 1 - alpha (1 - t)
PLD_FN PublishedSums unpackPublished(vec4 radiance, vec4 beta, vec2 delta) {
  precise float variance = beta.a * (PLD_SCATTER_UNIT * PLD_SCATTER_UNIT);
  precise vec2 offset = delta * PLD_SCATTER_UNIT;
  PublishedSums sums;
  sums.numerator = vec3(radiance);
  sums.denominator = radiance.a;
  sums.beta = vec3(beta);
  sums.variance = variance;
  sums.offset = offset;
  return sums;
}

// PT17 listing 3, lines "suppress under- and over-flow" to the end, without the background.
PLD_FN Resolved resolvePublished(vec3 numerator, float denominator, vec3 beta, bool modulateSelf) {
  vec3 a = numerator;
  float total = denominator;
  if (total > PLD_HALF_LARGEST) total = max(a.r, max(a.g, a.b));
  if (max(a.r, max(a.g, a.b)) > PLD_HALF_LARGEST) {
    total = total > PLD_HALF_LARGEST ? 1.0f : total;
    a = vec3(total);
  }
  if (modulateSelf) {
    precise vec3 modulated = a * selfModulation(beta);
    a = modulated;
  }
  precise vec3 transparent = (vec3(1.0f) - beta) * (a / max(total, PLD_LEAST_DENOMINATOR));
  Resolved resolved;
  resolved.transparent = transparent;
  resolved.transmission = beta;
  return resolved;
}
