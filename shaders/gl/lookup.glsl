#pragma once
// The textures that shared/gather.glsl looks things up in.
#include "gl/spread_texels.glsl"

layout(binding = 0) uniform sampler2D background;  // scene-linear, premultiplied, and alpha
layout(binding = 5) uniform sampler2D opaqueZ;     // planar metres, +inf where nothing was hit
layout(binding = 6) uniform sampler2D solid;       // nearest fragment that hides everything: rgb, planar z
layout(binding = 8) uniform sampler2D refraction;  // sums of W delta, W, s^2

const float kNoDepth = 3e38f;

ivec2 inPicture(ivec2 pixel) { return clamp(pixel, ivec2(0), textureSize(opaqueZ, 0) - 1); }

vec4 backdropColour(ivec2 pixel) {
  ivec2 place = inPicture(pixel);
  vec4 front = texelFetch(solid, place, 0);
  return front.a < kNoDepth ? vec4(front.rgb, 1.0f) : texelFetch(background, place, 0);
}

float backdropDepth(ivec2 pixel) {
  ivec2 place = inPicture(pixel);
  return min(texelFetch(opaqueZ, place, 0).r, texelFetch(solid, place, 0).a);
}

float spreadAt(ivec2 pixel) { return texelFetch(refraction, inPicture(pixel), 0).w; }

#include "shared/gather.glsl"
