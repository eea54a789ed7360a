#pragma once
// What one layer adds to the sums of a pixel. Everything here is a sum, so order is irrelevant but for rounding.
#include "shared/scattering.glsl"
#include "shared/weight.glsl"

const int PLD_NORMALISE_SPECTRAL = 0;   // per channel, MODEL section 3
const int PLD_NORMALISE_PUBLISHED = 1;  // scalar denominator, PT17 eq. 4

// One transparent surface sample, shaded.
struct Layer {
  vec3 radiance;      // premultiplied, scene-linear: C = coverage * L_r + E, >= 0
  float coverage;     // [0,1]; 0 marks additive light
  vec3 transmission;  // t at the actual angle, [0,1]
  float z;            // planar metres, > 0
};

// The planes of one pixel. See gbuffer/channels.h for their names in files.
struct OitSums {
  vec3 numerator;      // A: sum of w C
  vec3 denominator;    // W: sum of w o
  vec3 opacity;        // O: sum of o
  vec3 depth;          // tau: sum of -ln(1 - o)
  vec3 light;          // E: sum of C that adds
  float lightWeight;   // sum of w_z * mean(C that adds); w_z is depthWeight
  float opacityWeight; // sum of w_z * mean(o)
  float opacityZ;      // sum of mean(o) * z
  float count;         // layers
};

PLD_FN bool isAdditive(float coverage, float transmission) {
  return coverage == 0.0f || 1.0f - transmission < PLD_CLEAR;
}

// A fragment that hides everything: kept as the nearest solid, never blended. DESIGN, Materials
PLD_FN bool isSolid(float coverage, vec3 transmission) {
  return coverage >= 1.0f && transmission.r == 0.0f && transmission.g == 0.0f && transmission.b == 0.0f;
}

// What a layer adds.
//   w, wz  its weight, and the part of it that depends on depth alone
PLD_FN OitSums weighedSums(Layer layer, float w, float wz, int normalisation) {
  vec3 o = opacityOf(layer.coverage, layer.transmission);
  float netOpacity = meanOf(o);
  vec3 adds = vec3(0.0f);
  if (normalisation == PLD_NORMALISE_SPECTRAL) {
    adds.r = isAdditive(layer.coverage, layer.transmission.r) ? 1.0f : 0.0f;
    adds.g = isAdditive(layer.coverage, layer.transmission.g) ? 1.0f : 0.0f;
    adds.b = isAdditive(layer.coverage, layer.transmission.b) ? 1.0f : 0.0f;
  } else if (layer.coverage == 0.0f) {
    adds = vec3(1.0f);
  }
  precise vec3 averages = vec3(1.0f) - adds;
  precise vec3 hidden = averages * o;
  if (normalisation == PLD_NORMALISE_PUBLISHED) hidden = averages * vec3(netOpacity);
  precise vec3 light = adds * layer.radiance;
  precise float meanHidden = meanOf(hidden);

  precise vec3 numerator = w * (averages * layer.radiance);
  precise vec3 denominator = w * hidden;
  precise float lightWeight = wz * meanOf(light);
  precise float opacityWeight = wz * meanHidden;
  precise float opacityZ = meanHidden * layer.z;
  OitSums sums;
  sums.numerator = numerator;
  sums.denominator = denominator;
  sums.opacity = hidden;
  sums.depth = opticalDepth3(o, passedBy(layer.coverage, layer.transmission));
  sums.light = light;
  sums.lightWeight = lightWeight;
  sums.opacityWeight = opacityWeight;
  sums.opacityZ = opacityZ;
  sums.count = 1.0f;
  return sums;
}

PLD_FN OitSums layerSums(Layer layer, WeightSettings settings, int normalisation) {
  float netOpacity = meanOf(opacityOf(layer.coverage, layer.transmission));
  return weighedSums(layer, layerWeight(settings, layer.z, netOpacity), depthWeight(settings, layer.z), normalisation);
}

// How sums lie in RGBA32F targets, encoder beside decoder.
struct OitTargets {
  vec4 radiance;  // A.rgb, opacityWeight
  vec4 weight;    // W.rgb, count
  vec4 opacity;   // O.rgb, opacityZ
  vec4 depth;     // tau.rgb, lightWeight
  vec4 light;     // E.rgb, unused
};

PLD_FN OitTargets packSums(OitSums sums) {
  OitTargets targets;
  targets.radiance = vec4(sums.numerator, sums.opacityWeight);
  targets.weight = vec4(sums.denominator, sums.count);
  targets.opacity = vec4(sums.opacity, sums.opacityZ);
  targets.depth = vec4(sums.depth, sums.lightWeight);
  targets.light = vec4(sums.light, 0.0f);
  return targets;
}

// The same sums where every layer transmits all colours alike: one denominator, one opacity, one optical depth.
struct GreyTargets {
  vec4 radiance;  // A.rgb, W
  vec4 opacity;   // O, opacityWeight, opacityZ, count
  vec2 depth;     // tau, lightWeight
};

PLD_FN GreyTargets packGrey(OitSums sums) {
  GreyTargets targets;
  targets.radiance = vec4(sums.numerator, sums.denominator.r);
  targets.opacity = vec4(sums.opacity.r, sums.opacityWeight, sums.opacityZ, sums.count);
  targets.depth = vec2(sums.depth.r, sums.lightWeight);
  return targets;
}

PLD_FN OitTargets unpackGrey(GreyTargets grey, vec4 light) {
  OitTargets targets;
  targets.radiance = vec4(vec3(grey.radiance), grey.opacity.y);
  targets.weight = vec4(vec3(grey.radiance.a), grey.opacity.a);
  targets.opacity = vec4(vec3(grey.opacity.x), grey.opacity.z);
  targets.depth = vec4(vec3(grey.depth.x), grey.depth.y);
  targets.light = light;
  return targets;
}

PLD_FN OitSums unpackSums(OitTargets targets) {
  OitSums sums;
  sums.numerator = vec3(targets.radiance);
  sums.denominator = vec3(targets.weight);
  sums.opacity = vec3(targets.opacity);
  sums.depth = vec3(targets.depth);
  sums.light = vec3(targets.light);
  sums.lightWeight = targets.depth.a;
  sums.opacityWeight = targets.radiance.a;
  sums.opacityZ = targets.opacity.a;
  sums.count = targets.weight.a;
  return sums;
}
