#pragma once
// What an engine's shader holds to ask how much of a light transparent casters leave. LIGHTS, FACES, EDGE, CHANNELS
// say how the maps lie: face f's channel c is layer f * CHANNELS + c.
#include "shared/shadow_map.glsl"

PLD_FRAME_LAYOUT uniform PldShadows {
  ShadowLight pldShadowLights[LIGHTS];
  ShadowFace pldShadowFaces[FACES];
};
PLD_UNIT_0 uniform sampler2DArray pldShadowMaps;

ShadowLight shadowLight(int light) { return pldShadowLights[light]; }

ShadowFace shadowFace(int face) { return pldShadowFaces[face]; }

vec4 shadowTexel(int index) {
  int place = index / CHANNELS;
  int row = place / EDGE;
  int face = row / EDGE;
  int layer = face * CHANNELS + index - place * CHANNELS;
  return texelFetch(pldShadowMaps, ivec3(place - row * EDGE, row - face * EDGE, layer), 0);
}

#include "shared/shadow_lookup.glsl"

// RGB part of a light that transparent casters leave, [0,1]; 1 where no map reaches.
//   point  in the space that pld_shadow_view.light_from_scene starts from
// In the air, or on a transparent surface:
vec3 pldShadow(int light, vec3 point) {
  return light < 0 || light >= LIGHTS ? vec3(1.0f) : transparentVisibility(light, point, false);
}

// On an opaque surface, which every caster that its texel knows stands before.
vec3 pldShadowOnOpaque(int light, vec3 point) {
  return light < 0 || light >= LIGHTS ? vec3(1.0f) : transparentVisibility(light, point, true);
}
