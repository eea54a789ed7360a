#pragma once
// What layers leave of a pixel, over its background.
#include "shared/resolve.glsl"

// 0 hides even what is not finite; for finite light this changes no bit.
PLD_FN vec3 throughOnly(vec3 passed, vec3 seen) {
  return vec3(passed.r > 0.0f ? seen.r : 0.0f, passed.g > 0.0f ? seen.g : 0.0f, passed.b > 0.0f ? seen.b : 0.0f);
}

// rgb and alpha of a pixel.
//   direct   its layers, and what they let through of the pixel's own background
//   applied  what they let through of other places, times what is seen there; its mean times (1 - the alpha there)
PLD_FN vec4 pictureOver(Resolved direct, vec4 background, vec4 applied) {
  vec3 over = overBackground(direct, throughOnly(direct.transmission, vec3(background)));
  precise vec3 colour = over + vec3(applied);
  precise float alpha = alphaOver(direct.transmission, background.a) - applied.a;
  return vec4(colour, alpha);
}
