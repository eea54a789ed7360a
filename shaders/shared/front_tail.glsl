#pragma once
// The nearest layer of a pixel exactly, over weighted sums of the others. MODEL section 9
#include "shared/resolve.glsl"

// Layers nearer than this to the nearest one, relative to it, are taken for one surface with it: a second draw of the same
// triangle may round its depth otherwise.
const float PLD_SAME_FRONT = 1e-6f;

PLD_FN bool isFront(float z, float frontZ) {
  precise float most = frontZ * (1.0f + PLD_SAME_FRONT);
  return z <= most;
}

// What a front layer adds.
struct FrontTargets {
  vec4 radiance;  // C, layers
  vec4 depth;     // tau.rgb, unused
};

//   depth  its optical depth, as in the sums
PLD_FN FrontTargets packFront(Layer layer, vec3 depth) {
  FrontTargets targets;
  targets.radiance = vec4(layer.radiance, 1.0f);
  targets.depth = vec4(depth, 0.0f);
  return targets;
}

// Coincident layers merge by optical depth, one channel.
PLD_FN float mergedFront(float radiance, float netOpacity, float depth, float layers) {
  if (layers <= 1.0f || depth <= 0.0f) return radiance;
  precise float merged = radiance * (netOpacity / depth);
  return merged;
}

PLD_FN Resolved frontOverTail(FrontTargets front, Resolved tail) {
  vec3 depth = vec3(front.depth);
  vec3 beta = transmittanceOf(depth);
  vec3 net = netOpacityOf(depth, beta);
  vec3 light;
  light.r = mergedFront(front.radiance.r, net.r, depth.r, front.radiance.a);
  light.g = mergedFront(front.radiance.g, net.g, depth.g, front.radiance.a);
  light.b = mergedFront(front.radiance.b, net.b, depth.b, front.radiance.a);
  precise vec3 transparent = light + beta * tail.transparent;
  precise vec3 transmission = beta * tail.transmission;
  Resolved resolved;
  resolved.transparent = transparent;
  resolved.transmission = transmission;
  return resolved;
}
