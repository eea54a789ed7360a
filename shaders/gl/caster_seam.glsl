#pragma once
// What an engine's shader of transparent casters holds: the outputs of a shadow map, and pldWriteCaster().
#include "gl/caster_output.glsl"
#include "shared/material.glsl"

// METRIC is a name that says how many channels the text is for: with PLD_FLAG_VALIDATE pld_shadow_end() looks for it.
PLD_FRAME_LAYOUT uniform PldShadowFrame {
  vec4 METRIC;           // depth = x * (planar z, or distance) + y; z: not 0 for distance; w: not 0 for naive coins
  uvec4 pldShadowSeed;   // of the map
};

// One transparent surface as its light sees it.
struct PldCaster {
  float coverage;     // part of the texel it touches, [0,1]
  vec3 transmission;  // colour let straight through where it touches, at the light's angle, [0,1]
  vec3 position;      // in the light's view space, which looks down -z; a sun's may lie at any z
  vec3 normal;        // there, unit, either side
  float eta;          // index outside over inside: below 1 it makes a caustic; not > 0 is as 1
  uint identity;      // of the triangle, the same every frame: pldCasterIdentity()
};

// instance: a number for the object; triangle: within it.
uint pldCasterIdentity(uint instance, uint triangle) { return identityOf(instance, triangle); }

void pldWriteCaster(PldCaster caster) {
  bool radial = METRIC.z != 0.0f;
  // A local light sees what lies before it. A sun has no place: its projection alone says what it sees.
  bool seen = radial ? -caster.position.z > 0.0f : abs(caster.position.z) <= 3e38f;
  if (!seen || !(caster.coverage > 0.0f)) discard;
  float depth = METRIC.x * (radial ? length(caster.position) : -caster.position.z) + METRIC.y;
  vec3 toLight = radial ? normalize(-caster.position) : vec3(0.0f, 0.0f, 1.0f);
  float cosLight = clamp(abs(dot(caster.normal, toLight)), PLD_GRAZING, 1.0f);
  vec3 hidden = opacityOf(clamp(caster.coverage, 0.0f, 1.0f), clamp(caster.transmission, vec3(0.0f), vec3(1.0f)));
  writeCaster(shadowDensity(hidden, cosLight, caster.eta > 0.0f ? caster.eta : 1.0f), depth, uvec2(gl_FragCoord.xy),
              casterKeyOf(caster.identity, pldShadowSeed.x), METRIC.w != 0.0f);
}
