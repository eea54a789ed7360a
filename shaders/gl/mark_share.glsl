#pragma once
// How much a layer counts among what is told of a pixel's layers together.
#include "shared/accumulate.glsl"

// The mean of its opacity over the channels to which it does not add light, as the sums have it.
float markShare(float coverage, vec3 transmission) {
  vec3 o = opacityOf(coverage, transmission);
  for (int c = 0; c < 3; ++c)
    if (isAdditive(coverage, transmission[c])) o[c] = 0.0f;
  return meanOf(o);
}
