#pragma once
#include "shared/front_tail.glsl"

layout(binding = 8) uniform sampler2D frontRadiance;  // front and tail do not scatter: the places of those planes are free
layout(binding = 10) uniform sampler2D frontDepth;

FrontTargets frontAt(ivec2 pixel) {
  FrontTargets targets;
  targets.radiance = texelFetch(frontRadiance, pixel, 0);
  targets.depth = texelFetch(frontDepth, pixel, 0);
  return targets;
}
