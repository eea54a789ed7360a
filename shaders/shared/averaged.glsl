#pragma once
// The sums of scenes where every layer is averaged and none adds light: nothing weighs light against its occluders, so
// nothing else is kept.
#include "shared/accumulate.glsl"

struct AveragedTargets {
  vec4 radiance;  // A.rgb, layers; grey: A.rgb, W
  vec4 weight;    // W.rgb, refraction's depth where layers refract; grey: not kept
  vec4 depth;     // tau.rgb, unused; grey: tau, layers, refraction's depth, unused. The alpha may hold the nearest
                  // depth that diffuses
};

PLD_FN AveragedTargets packAveraged(OitSums sums, bool grey) {
  AveragedTargets targets;
  targets.radiance = vec4(sums.numerator, grey ? sums.denominator.r : sums.count);
  targets.weight = vec4(sums.denominator, 0.0f);
  targets.depth = grey ? vec4(sums.depth.r, sums.count, 0.0f, 0.0f) : vec4(sums.depth, 0.0f);
  return targets;
}

PLD_FN OitSums unpackAveraged(AveragedTargets targets, bool grey) {
  OitSums sums;
  sums.numerator = vec3(targets.radiance);
  sums.denominator = grey ? vec3(targets.radiance.a) : vec3(targets.weight);
  sums.opacity = vec3(0.0f);
  sums.depth = grey ? vec3(targets.depth.x) : vec3(targets.depth);
  sums.light = vec3(0.0f);
  sums.lightWeight = 0.0f;
  sums.opacityWeight = 0.0f;
  sums.opacityZ = 0.0f;
  sums.count = grey ? targets.depth.y : targets.radiance.a;
  return sums;
}
