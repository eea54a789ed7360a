#pragma once
// Sums to picture: transmittance * background + (1 - transmittance) * mean of the layers + visible additive light.
#include "shared/accumulate.glsl"

struct Resolved {
  vec3 transparent;   // premultiplied light of the layers: (1 - beta) U + V E
  vec3 transmission;  // beta
};

// PT17 eq. 14, the unbiased form: the hue of the transmitted light, imposed on the layers behind each other.
PLD_FN vec3 selfModulation(vec3 beta) {
  precise float largest = max(1e-3f, max(beta.r, max(beta.g, beta.b)));
  precise vec3 factor = vec3(0.5f) + max(beta, vec3(1e-3f)) / (2.0f * largest);
  return factor;
}

// Part of the additive light that the occluders leave, one channel. MODEL section 3
//   ratio  mean weight of the light over mean weight of the occluders, >= 0
PLD_FN float lightVisibility(float beta, float netOpacity, float ratio) {
  precise float visible = beta + netOpacity * (ratio / (1.0f + ratio));
  return visible;
}

PLD_FN float meanColour(float numerator, float denominator) {
  if (denominator <= 0.0f) return 0.0f;
  precise float mean = numerator / denominator;
  return mean;
}

PLD_FN Resolved resolveSums(OitSums sums, bool modulateSelf) {
  vec3 beta = transmittanceOf(sums.depth);
  vec3 net = netOpacityOf(sums.depth, beta);
  vec3 mean;
  mean.r = meanColour(sums.numerator.r, sums.denominator.r);
  mean.g = meanColour(sums.numerator.g, sums.denominator.g);
  mean.b = meanColour(sums.numerator.b, sums.denominator.b);
  if (modulateSelf) {
    precise vec3 modulated = mean * selfModulation(beta);
    mean = modulated;
  }
  vec3 visible = vec3(1.0f);
  float meanLight = meanOf(sums.light);
  float meanHidden = meanOf(sums.opacity);
  if (meanLight > 0.0f && meanHidden > 0.0f && sums.opacityWeight > 0.0f) {
    precise float ratio = min((sums.lightWeight / meanLight) / (sums.opacityWeight / meanHidden), 1e12f);
    visible.r = sums.opacity.r > 0.0f ? lightVisibility(beta.r, net.r, ratio) : 1.0f;
    visible.g = sums.opacity.g > 0.0f ? lightVisibility(beta.g, net.g, ratio) : 1.0f;
    visible.b = sums.opacity.b > 0.0f ? lightVisibility(beta.b, net.b, ratio) : 1.0f;
  }
  precise vec3 transparent = net * mean + visible * sums.light;
  Resolved resolved;
  resolved.transparent = transparent;
  resolved.transmission = beta;
  return resolved;
}

// The picture from what a Resolved leaves and a background.
PLD_FN vec3 overBackground(Resolved resolved, vec3 background) {
  precise vec3 picture = resolved.transparent + resolved.transmission * background;
  return picture;
}

// 1 - (1 - A_background) * mean beta. MODEL section 1
PLD_FN float alphaOver(vec3 transmission, float backgroundAlpha) {
  precise float alpha = 1.0f - (1.0f - backgroundAlpha) * meanOf(transmission);
  return alpha;
}
