#pragma once
// The spread pyramid in textures: all levels in one atlas, below each other, each with its margin. Encoder beside
// decoder.
#include "shared/spread_pyramid.glsl"

layout(binding = 11) uniform sampler2D spreadColour;       // body.colour
layout(binding = 12) uniform sampler2D spreadLimits;       // mass, leastReach, mostReach, leastRate
layout(binding = 13) uniform sampler2D spreadMoments;      // mostRate, reachMass, rateMass
layout(binding = 14) uniform sampler2D spreadReachColour;
layout(binding = 15) uniform sampler2D spreadRateColour;

uniform ivec4 spreadLevels[25];  // of each level: width and height with its margins, its first row in the atlas

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

ivec2 placeInAtlas(int level, ivec2 texel) {
  ivec4 part = spreadLevels[level];
  return clamp(texel + PLD_SPREAD_MARGIN, ivec2(0), part.xy - 1) + ivec2(0, part.z);
}

SpreadBody spreadBody(int level, ivec2 texel) {
  ivec2 place = placeInAtlas(level, texel);
  vec4 limits = texelFetch(spreadLimits, place, 0);
  SpreadBody body;
  body.colour = texelFetch(spreadColour, place, 0);
  body.mass = limits.x;
  body.leastReach = limits.y;
  body.mostReach = limits.z;
  body.leastRate = limits.w;
  body.mostRate = texelFetch(spreadMoments, place, 0).x;
  return body;
}

SpreadTexel spreadTexel(int level, ivec2 texel) {
  ivec2 place = placeInAtlas(level, texel);
  vec4 moments = texelFetch(spreadMoments, place, 0);
  SpreadTexel result;
  result.body = spreadBody(level, texel);
  result.reachMass = moments.y;
  result.rateMass = moments.z;
  result.reachColour = texelFetch(spreadReachColour, place, 0);
  result.rateColour = texelFetch(spreadRateColour, place, 0);
  return result;
}
