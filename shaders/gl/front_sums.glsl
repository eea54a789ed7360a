#pragma once
// The nearest layer of a pixel, and what was drawn at low resolution and lies before it.
#include "shared/front_tail.glsl"

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
