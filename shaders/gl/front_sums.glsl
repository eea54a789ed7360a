#pragma once
#include "shared/front_tail.glsl"

layout(binding = 8) uniform sampler2D frontRadiance;  // front and tail do not scatter: the places of those planes are free
layout(binding = 10) uniform sampler2D frontDepth;

FrontTargets frontAt(ivec2 pixel) {
  FrontTargets targets;
  targets.radiance = texelHere(frontRadiance, pixel);
#ifdef GREY
  targets.depth = vec4(vec3(texelHere(frontDepth, pixel).r), 0.0f);
#else
  targets.depth = texelHere(frontDepth, pixel);
#endif
  return targets;
}

#ifdef LOW_OVER
layout(binding = 11) uniform sampler2D overRadiance;  // what was drawn at low resolution and lies before the nearest layer
layout(binding = 12) uniform sampler2D overDepth;

FrontTargets overAt(ivec2 pixel) {
  FrontTargets targets;
  targets.radiance = texelHere(overRadiance, pixel);
#ifdef GREY
  targets.depth = vec4(vec3(texelHere(overDepth, pixel).r), 0.0f);
#else
  targets.depth = texelHere(overDepth, pixel);
#endif
  return targets;
}
#endif
