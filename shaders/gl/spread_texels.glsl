#pragma once
// The spread pyramid in textures: all levels in one atlas, below each other, each with its margin. Encoder beside
// decoder. Defines: SPREAD_LAYERS (the atlas has two layers, of odd and of even levels, so that no level is drawn to
// what it reads), NO_PYRAMID (nothing diffuses, and no level is looked up).
#include "shared/spread_pyramid.glsl"

#ifndef NO_PYRAMID
#ifdef SPREAD_LAYERS
#define SPREAD_SAMPLER sampler2DArray
#define SPREAD_FETCH(plane, level, place) texelFetch(plane, ivec3(place, (level + 1) & 1), 0)
#else
#define SPREAD_SAMPLER sampler2D
#define SPREAD_FETCH(plane, level, place) texelFetch(plane, place, 0)
#endif
layout(binding = 11) uniform SPREAD_SAMPLER spreadColour;       // body.colour
layout(binding = 12) uniform SPREAD_SAMPLER spreadLimits;       // mass, leastReach, mostReach, leastRate
layout(binding = 13) uniform SPREAD_SAMPLER spreadMoments;      // mostRate, reachMass, rateMass
layout(binding = 14) uniform SPREAD_SAMPLER spreadReachColour;
layout(binding = 15) uniform SPREAD_SAMPLER spreadRateColour;

uniform ivec4 spreadLevels[25];  // of each level: width and height with its margins, its first row in the atlas
#endif

struct SpreadTargets {
  vec4 colour, limits, moments, reachColour, rateColour;
};

SpreadTargets encodeSpread(SpreadTexel texel) {
  SpreadTargets targets;
  targets.colour = texel.body.colour;
  targets.limits = vec4(texel.body.mass, texel.body.leastReach, texel.body.mostReach, texel.body.leastRate);
  targets.moments = vec4(texel.body.mostRate, texel.reachMass, texel.rateMass, 0.0f);
  targets.reachColour = texel.reachColour;
  targets.rateColour = texel.rateColour;
  return targets;
}

#ifdef NO_PYRAMID
SpreadBody spreadBody(int level, ivec2 texel) { return emptySpreadTexel().body; }
SpreadTexel spreadTexel(int level, ivec2 texel) { return emptySpreadTexel(); }
#else
ivec2 placeInAtlas(int level, ivec2 texel) {
  ivec4 part = spreadLevels[level];
  return clamp(texel + PLD_SPREAD_MARGIN, ivec2(0), part.xy - 1) + ivec2(0, part.z);
}

SpreadBody spreadBody(int level, ivec2 texel) {
  ivec2 place = placeInAtlas(level, texel);
  vec4 limits = SPREAD_FETCH(spreadLimits, level, place);
  SpreadBody body;
  body.colour = SPREAD_FETCH(spreadColour, level, place);
  body.mass = limits.x;
  body.leastReach = limits.y;
  body.mostReach = limits.z;
  body.leastRate = limits.w;
  body.mostRate = SPREAD_FETCH(spreadMoments, level, place).x;
  return body;
}

SpreadTexel spreadTexel(int level, ivec2 texel) {
  ivec2 place = placeInAtlas(level, texel);
  vec4 moments = SPREAD_FETCH(spreadMoments, level, place);
  SpreadTexel result;
  result.body = spreadBody(level, texel);
  result.reachMass = moments.y;
  result.rateMass = moments.z;
  result.reachColour = SPREAD_FETCH(spreadReachColour, level, place);
  result.rateColour = SPREAD_FETCH(spreadRateColour, level, place);
  return result;
}
#endif
