#pragma once
// Depth weights of blended transparency. WB13 eqs. 7-10, PT17 eq. 5.
#include "shared/numeric.glsl"

const int PLD_WEIGHT_EQ5 = 0;
const int PLD_WEIGHT_EQ7 = 1;
const int PLD_WEIGHT_EQ8 = 2;
const int PLD_WEIGHT_EQ9 = 3;
const int PLD_WEIGHT_EQ10 = 4;
const int PLD_WEIGHT_EQ7Z = 5;
const int PLD_WEIGHT_EQ8Z = 6;
const int PLD_WEIGHT_EQ9Z = 7;
const int PLD_WEIGHT_EQ10Z = 8;
const int PLD_WEIGHT_POWER = 9;
const int PLD_WEIGHT_UNIFORM = 10;
const int PLD_WEIGHT_FIG1 = 11;
const int PLD_WEIGHT_FIG6 = 12;
const int PLD_WEIGHT_FIG10 = 13;
const int PLD_WEIGHT_LINEAR = 14;

// The most and the least that a weight of a reference depth may be, as powers of 2. Above: what float sums bear without
// overflow at radiance 1e20 and 100,000 layers. Below: what a layer of opacity 1e-11 leaves normalised.
const float PLD_WEIGHT_MOST_OCTAVES = 39.86f;
const float PLD_WEIGHT_LEAST_OCTAVES = -86.0f;

struct WeightSettings {
  int kind;         // PLD_WEIGHT_*
  float rangeNear;  // metres, > 0: where window depth is 0 (weights of a range only)
  float rangeFar;   // metres, > rangeNear: where it is 1
  float exponent;   // k of |z|^-k, or of WB13 figures 10 and 11
  // metres, > 0. Of powers: where they weigh 1; the mean of the layers is the same for any. Of functions whose constants
  // are lengths: the unit of those, 1 as the papers have them.
  float reference;
};

// gl_FragCoord.z of a planar distance z, for the stated range. [0,1]. WB13 eq. 11
PLD_FN float windowDepth(float z, float rangeNear, float rangeFar) {
  precise float d = (rangeFar * (z - rangeNear)) / (z * (rangeFar - rangeNear));
  return clamp(d, 0.0f, 1.0f);
}

PLD_FN float cubeOf(float x) {
  precise float y = x * x * x;
  return y;
}

// PT17 eq. 5; netOpacity is coverage * (1 - mean t).
PLD_FN float weightEq5(float d, float netOpacity) {
  precise float base = 10.0f * (1.0f - 0.99f * d) * netOpacity;
  return clamp(cubeOf(base), 0.01f, 30.0f);
}

// WB13 eq. 7 without its factor alpha.
PLD_FN float weightEq7(float z) {
  precise float a = z / 5.0f;
  precise float b = min(z / 200.0f, 1e5f);
  precise float w = 10.0f / (1e-5f + min(a * a, 1e30f) + cubeOf(b) * cubeOf(b));
  return clamp(w, 0.01f, 3e3f);
}

// WB13 eq. 8 without its factor alpha.
PLD_FN float weightEq8(float z) {
  precise float a = min(z / 10.0f, 1e10f);
  precise float b = min(z / 200.0f, 1e5f);
  precise float w = 10.0f / (1e-5f + cubeOf(a) + cubeOf(b) * cubeOf(b));
  return clamp(w, 0.01f, 3e3f);
}

// WB13 eq. 9 without its factor alpha.
PLD_FN float weightEq9(float z) {
  precise float a = min(z / 200.0f, 1e7f);
  precise float b = a * a;
  precise float w = 0.03f / (1e-5f + b * b);
  return clamp(w, 0.01f, 3e3f);
}

// WB13 eq. 10 without its factor alpha.
PLD_FN float weightEq10(float d) {
  precise float w = 3e3f * cubeOf(1.0f - d);
  return max(w, 0.01f);
}

// z to the power of -exponent. z in references: one that is a power of 2 rounds nothing.
PLD_FN float weightPower(float z, float exponent) {
  precise float octaves = -exponent * pldLog2(z);
  return pldExp2(clamp(octaves, PLD_WEIGHT_LEAST_OCTAVES, PLD_WEIGHT_MOST_OCTAVES));
}

// WB13 figure 1: (|z| + 5)^-2, for billboards between 1 and 5 units.
PLD_FN float weightFig1(float z) {
  precise float a = min(z, 1e10f) + 5.0f;
  precise float w = 1.0f / (a * a);
  return w;
}

// WB13 figures 10 and 11: 10 / (1 + 10 |z k|^5).
PLD_FN float weightFig10(float z, float k) {
  precise float a = min(z * k, 1e5f);
  precise float w = 10.0f / (1.0f + 10.0f * (a * a * cubeOf(a)));
  return w;
}

// WB13 section 3.4: z - z_far + epsilon, as a share of the range and epsilon a thousandth of it.
PLD_FN float weightLinear(float z, float rangeNear, float rangeFar) {
  precise float share = (rangeFar - z) / (rangeFar - rangeNear);
  return clamp(share, 0.0f, 1e3f) + 1e-3f;
}

// Weight by depth alone: monotone, falling. What additive light is compared by. z > 0 metres.
PLD_FN float depthWeight(WeightSettings settings, float z) {
  float d = windowDepth(z, settings.rangeNear, settings.rangeFar);
  precise float units = z / settings.reference;
  if (settings.kind == PLD_WEIGHT_EQ5) return weightEq5(d, 1.0f);
  if (settings.kind == PLD_WEIGHT_EQ7 || settings.kind == PLD_WEIGHT_EQ7Z) return weightEq7(units);
  if (settings.kind == PLD_WEIGHT_EQ8 || settings.kind == PLD_WEIGHT_EQ8Z) return weightEq8(units);
  if (settings.kind == PLD_WEIGHT_EQ9 || settings.kind == PLD_WEIGHT_EQ9Z) return weightEq9(units);
  if (settings.kind == PLD_WEIGHT_EQ10 || settings.kind == PLD_WEIGHT_EQ10Z) return weightEq10(d);
  if (settings.kind == PLD_WEIGHT_POWER) return weightPower(units, settings.exponent);
  if (settings.kind == PLD_WEIGHT_FIG1) return weightFig1(units);
  if (settings.kind == PLD_WEIGHT_FIG6) return weightPower(units, 6.0f);
  if (settings.kind == PLD_WEIGHT_FIG10) return weightFig10(units, settings.exponent);
  if (settings.kind == PLD_WEIGHT_LINEAR) return weightLinear(z, settings.rangeNear, settings.rangeFar);
  return 1.0f;
}

// Weight of a layer in the sums. netOpacity = mean of o over channels, the alpha of WB13.
PLD_FN float layerWeight(WeightSettings settings, float z, float netOpacity) {
  if (settings.kind == PLD_WEIGHT_EQ5)
    return weightEq5(windowDepth(z, settings.rangeNear, settings.rangeFar), netOpacity);
  float byDepth = depthWeight(settings, z);
  if (settings.kind >= PLD_WEIGHT_EQ7 && settings.kind <= PLD_WEIGHT_EQ10) {
    precise float printed = netOpacity * byDepth;
    return printed;
  }
  if (settings.kind == PLD_WEIGHT_FIG6) {
    precise float printed = netOpacity * netOpacity * byDepth;
    return max(printed, 1e-25f);
  }
  return byDepth;
}
