#pragma once
// The light that rims get from around, apart from the sums: gbuffer/rim_planes.h. Targets add.
#include "shared/accumulate.glsl"
#include "shared/material.glsl"

PLANE_OUTPUTS

//   around  what no occlusion leaves of the layer's radiance and full occlusion takes, premultiplied
void writeRim(Layer layer, vec3 around, vec2 gradient, WeightSettings settings) {
  Layer part = layer;
  part.radiance = min(around, vec3(PLD_BRIGHTEST));
  OitSums sums = layerSums(part, settings, NORMALISATION);
  float k = layer.coverage * depthWeight(settings, layer.z);
  averagedRim = vec4(sums.numerator, k);
  addedRim = vec4(sums.light, k * layer.z);
  rimGradient = k * gradient;
}
