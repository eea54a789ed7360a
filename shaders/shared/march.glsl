#pragma once
// The march through fog. Whoever includes this says where numbers come from, by these functions; texels are clamped to the
// volume by the callee:
//   float densityTexel(ivec3 texel)               of the grid, a factor, >= 0
//   vec3 emissionTexel(ivec3 texel)               of the same grid where it emits: radiance that a metre adds
//   vec3 visibilityTexel(int light, ivec3 texel)  part of a light that reaches a texel of the light volume, [0,1]
//   PunctualLight lightNumber(int light)          view space
// and by these values: ivec3 gridSize, bool hasVisibility, mat4 volumeFromView (to texels, centres at +0.5), int lightsOfFog.
#include "shared/light_volume.glsl"
#include "shared/medium.glsl"

PLD_FN float densityAt(vec3 at) {
  Trilinear t = trilinearAt(at);
  float a = mixed(densityTexel(t.low), densityTexel(t.low + ivec3(1, 0, 0)), t.part.x);
  float b = mixed(densityTexel(t.low + ivec3(0, 1, 0)), densityTexel(t.low + ivec3(1, 1, 0)), t.part.x);
  float c = mixed(densityTexel(t.low + ivec3(0, 0, 1)), densityTexel(t.low + ivec3(1, 0, 1)), t.part.x);
  float d = mixed(densityTexel(t.low + ivec3(0, 1, 1)), densityTexel(t.low + ivec3(1, 1, 1)), t.part.x);
  return mixed(mixed(a, b, t.part.y), mixed(c, d, t.part.y), t.part.z);
}

PLD_FN vec3 emissionAt(vec3 at) {
  Trilinear t = trilinearAt(at);
  vec3 a = mixed3(emissionTexel(t.low), emissionTexel(t.low + ivec3(1, 0, 0)), t.part.x);
  vec3 b = mixed3(emissionTexel(t.low + ivec3(0, 1, 0)), emissionTexel(t.low + ivec3(1, 1, 0)), t.part.x);
  vec3 c = mixed3(emissionTexel(t.low + ivec3(0, 0, 1)), emissionTexel(t.low + ivec3(1, 0, 1)), t.part.x);
  vec3 d = mixed3(emissionTexel(t.low + ivec3(0, 1, 1)), emissionTexel(t.low + ivec3(1, 1, 1)), t.part.x);
  return mixed3(mixed3(a, b, t.part.y), mixed3(c, d, t.part.y), t.part.z);
}

// Light that a step emits, see emittedByStep().
PLD_FN vec3 emittedInStep(Medium medium, FogStep part) {
  vec3 perMetre = vec3(0.0f);
  if (medium.glow.a != 0.0f) {
    vec4 at = medium.boxFromView * vec4(part.middle, 1.0f);
    perMetre = emissionAt(vec3(at) * vec3(gridSize));
  }
  return emittedByStep(medium, part, perMetre);
}

// Radiance scattered towards the eye per opacity, at a point.
PLD_FN vec3 scatteredAt(Medium medium, vec3 point, vec3 direction) {
  vec3 sent = ambientTowardsEye(medium, direction);
  for (int i = 0; i < lightsOfFog; ++i) {
    PunctualLight light = lightNumber(i);
    Arriving arriving = arrivingAt(light, point);
    if (arriving.irradiance.r + arriving.irradiance.g + arriving.irradiance.b <= 0.0f) continue;
    // Light travels along -toLight, then along -direction.
    float phase = henyeyGreenstein(dot(arriving.toLight, direction), medium.scattering.a);
    precise vec3 lit = (phase * lightPassed(medium, light, arriving.toLight, point)) * arriving.irradiance;
    if (hasVisibility) {
      vec4 at = volumeFromView * vec4(point, 1.0f);
      lit = lit * visibilityAt(i, vec3(at));
    }
    sent = sent + lit;
  }
  precise vec3 source = vec3(medium.scattering) * sent;
  return source;
}

PLD_FN FogStep fogStep(Medium medium, FogSpan span, int turn) {
  if (medium.extinction.w == 0.0f) return evenStep(medium, span, turn);
  FogStep part = gridStep(medium, span, turn);
  vec4 at = medium.boxFromView * vec4(part.middle, 1.0f);
  float density = densityAt(vec3(at) * vec3(gridSize));
  precise float depth = medium.extinction.x * density * (part.end - part.begin);
  part.depth = depth;
  return part;
}

// Optical depth of a whole ray.
PLD_FN float fogDepth(Medium medium, FogSpan span) {
  if (medium.extinction.w == 0.0f) return span.depth;
  float depth = 0.0f;
  for (int i = 0; i < int(medium.march.y); ++i) depth = depth + fogStep(medium, span, i).depth;
  return depth;
}

// Front to back over one ray. See fogShows().
PLD_FN FogSums marchFog(Medium medium, FogSpan span, WeightSettings settings, int order) {
  FogSums sums = noFog();
  float whole = fogDepth(medium, span);
  bool emits = mediumEmits(medium);
  if (!(whole > 0.0f) && !(medium.glow.a != 0.0f && span.end > span.start)) return sums;
  float netOpacity = pldOneMinusExp(whole);
  for (int i = 0; i < int(medium.march.y); ++i) {
    FogStep part = fogStep(medium, span, i);
    if (emits) sums = addEmitted(sums, part.z, emittedInStep(medium, part), settings);
    if (!(part.depth > 0.0f)) continue;
    sums = addStep(sums, part.depth, part.z, scatteredAt(medium, part.middle, span.direction), settings, netOpacity, order);
  }
  return sums;
}
