#pragma once
// Shadow maps under a fragment: shadowVisibility(light, point) and its like, of shared/shadow_lookup.glsl. Filled in by
// engine_bridge/gl/shadow_textures.h.
#include "shared/shadow_map.glsl"

// Row 0: how many lights; then four rows a light, six a face, as in gbuffer/shadow_maps.h.
layout(std430, binding = 0) readonly buffer ShadowTable { ivec4 shadowTable[]; };
layout(binding = 12) uniform samplerBuffer shadowTexels;

vec4 shadowRow(int row) { return intBitsToFloat(shadowTable[row]); }

vec4 shadowTexel(int index) { return texelFetch(shadowTexels, index); }

ShadowLight shadowLight(int index) {
  int row = 1 + 4 * index;
  ShadowLight light;
  light.metric = shadowRow(row);
  light.faces = shadowTable[row + 1];
  light.lookup = shadowTable[row + 2];
  light.bias = shadowRow(row + 3);
  return light;
}

ShadowFace shadowFace(int index) {
  int row = 1 + 4 * shadowTable[0].x + 6 * index;
  ShadowFace face;
  face.mapFromView = mat4(shadowRow(row), shadowRow(row + 1), shadowRow(row + 2), shadowRow(row + 3));
  face.extent = shadowTable[row + 4];
  face.inner = shadowRow(row + 5);
  return face;
}

#include "shared/shadow_lookup.glsl"
