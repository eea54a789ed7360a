#pragma once
// Light of a lat-long picture: the only place that fetches its atlas.
#include "gl/frame.glsl"
#include "shared/environment.glsl"

layout(binding = 11) uniform sampler2D surroundingsAtlas;

vec4 atlasAt(AtlasTaps taps) {
  return taps.weights.x * texelFetch(surroundingsAtlas, taps.a, 0) +
         taps.weights.y * texelFetch(surroundingsAtlas, taps.b, 0) +
         taps.weights.z * texelFetch(surroundingsAtlas, taps.c, 0) +
         taps.weights.w * texelFetch(surroundingsAtlas, taps.d, 0);
}

// Mean over all directions: of the diffuse level, along the axes, which leaves out its second order too.
vec3 environmentMean() {
  vec3 sum = vec3(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    vec3 along = vec3(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f);
    sum += atlasAt(directionTaps(along, PLD_DIFFUSE_LEVEL, atlasEdge)).rgb;
    sum += atlasAt(directionTaps(-along, PLD_DIFFUSE_LEVEL, atlasEdge)).rgb;
  }
  return sum / 6.0f;
}

//   normal, toEye  view space, unit
vec3 environmentReflected(Surface surface, vec3 normal, vec3 toEye, float cosEye) {
  GlossyLevels levels = glossyLevels(surface.roughness);
  vec3 worldNormal = mat3(worldFromView) * normal;
  vec3 mirrored = glossyDirection(worldNormal, mat3(worldFromView) * toEye, surface.roughness);
  vec3 first = atlasAt(directionTaps(mirrored, levels.first, atlasEdge)).rgb;
  vec3 second = atlasAt(directionTaps(mirrored, levels.second, atlasEdge)).rgb;
  vec3 diffuse = atlasAt(directionTaps(worldNormal, PLD_DIFFUSE_LEVEL, atlasEdge)).rgb;
  return reflectEnvironment(surface, cosEye, diffuse, first + (second - first) * levels.between,
                            atlasAt(tableTaps(cosEye, surface.roughness, atlasEdge)));
}
