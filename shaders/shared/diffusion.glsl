#pragma once
// How far a layer spreads what lies behind it, and how the spread background is gathered. PT17 eq. 7, MODEL section 4
#include "shared/refraction.glsl"

const int PLD_DIFFUSE_GAUSSIAN = 0;
const int PLD_DIFFUSE_DISC = 1;

const float PLD_LARGEST_SPREAD = 1e6f;  // pixels, one layer
const float PLD_GAUSSIAN_REACH = 4.0f;  // kappa: standard deviations
const int PLD_DISC_STRIDE = 2;          // PT17 listing 3
const float PLD_DISC_LARGEST = 16.0f;   // pixels
// Below the first a diffused lookup is the bilinear one, above the second the kernel's, in between both. Pixels
const float PLD_SPREAD_NONE = 0.25f;
const float PLD_SPREAD_FULL = 0.75f;

struct DiffusionSettings {
  float k0;          // metres
  float k1;          // metres: the distance behind the layer that gives half the spread
  int netCoverage;   // not 0: the factor is coverage * (1 - mean t), as in the published listing
  float focalPixels; // F_px
  int orthographic;  // not 0: focalPixels is pixels per metre
};

// c of a transmissive surface that does not state it. [0,1]
//   roughness  perceptual, [0,1]
//   diffuse    part of the transmitted light that is scattered evenly, [0,1]
PLD_FN float collimationOf(float roughness, float diffuse) {
  precise float collimation = (1.0f - roughness * roughness) * (1.0f - diffuse);
  return collimation;
}

// s^2 of one layer. Float pixels^2
//   collimation  c: 1 clear glass, 0 dense scattering medium
//   z            planar metres, > 0
//   backgroundZ  planar metres, > 0, +inf for sky
PLD_FN float layerVariance(DiffusionSettings settings, float coverage, vec3 transmission, float collimation, float z,
                           float backgroundZ) {
  float hides = settings.netCoverage != 0 ? meanOf(opacityOf(coverage, transmission)) : coverage;
  precise float behind = min(abs(backgroundZ - z), 1e12f);
  precise float reach = behind / (behind + settings.k1);
  precise float scale = settings.orthographic != 0 ? settings.focalPixels : settings.focalPixels / max(z, 1e-7f);
  precise float s = min(scale * settings.k0 * hides * (1.0f - collimation) * reach, PLD_LARGEST_SPREAD);
  precise float variance = s * s;
  return variance;
}

// Weight of a tap at squared distance r2 under a Gaussian. Pixels^2
PLD_FN float gaussianWeight(float r2, float variance) {
  precise float weight = pldExp(-0.5f * r2 / variance);
  return weight;
}

// Published disc: constant, but a tap that is itself spread farther weighs less. tapVariance: pixels^2
PLD_FN float discWeight(float tapVariance) {
  precise float weight = 1.0f / max(tapVariance, 1.0f);
  return weight;
}

// Whether a tap counts: what spreads less than its distance does not reach this pixel. MODEL section 4
//   reach2  kappa^2
PLD_FN bool tapCounts(float r2, float variance, float tapVariance, float reach2) {
  precise float most = reach2 * min(variance, tapVariance);
  return r2 <= most;
}

// How much of a lookup the kernel gives, the rest is the bilinear one. [0,1]
PLD_FN float kernelShare(float variance) {
  precise float share = (sqrt(variance) - PLD_SPREAD_NONE) / (PLD_SPREAD_FULL - PLD_SPREAD_NONE);
  return clamp(share, 0.0f, 1.0f);
}

// The standard deviation that the kernel uses. Pixels
PLD_FN float kernelSpread(float variance, float largest) {
  return clamp(sqrt(variance), PLD_SPREAD_FULL, largest);
}
