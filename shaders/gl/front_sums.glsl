#pragma once
#include "shared/front_tail.glsl"

layout(binding = 8) uniform sampler2D frontRadiance;  // front and tail do not scatter: the places of those planes are free
layout(binding = 10) uniform sampler2D frontDepth;
#ifdef LOW_OVER
layout(binding = 11) uniform sampler2D overRadiance;  // what was drawn at low resolution and lies before the nearest layer
layout(binding = 12) uniform sampler2D overDepth;
#endif

FrontTargets frontOf(sampler2D radiance, sampler2D depth, ivec2 pixel) {
  FrontTargets targets;
  targets.radiance = texelHere(radiance, pixel);
#ifdef GREY
  targets.depth = vec4(vec3(texelHere(depth, pixel).r), 0.0f);
#else
  targets.depth = texelHere(depth, pixel);
#endif
  return targets;
}

FrontTargets frontAt(ivec2 pixel) { return frontOf(frontRadiance, frontDepth, pixel); }
#ifdef LOW_OVER
FrontTargets overAt(ivec2 pixel) { return frontOf(overRadiance, overDepth, pixel); }
#endif
