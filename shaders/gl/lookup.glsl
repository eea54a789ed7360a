#pragma once
// The textures that shared/gather.glsl looks things up in. Defines: those of the planes (shaders/plane_defines.h);
// PART_OF_TEXTURE (the picture is a corner of its textures), NO_DEPTH (nothing is looked up elsewhere).
#include "gl/spread_texels.glsl"
#include "shared/resolve.glsl"  // here: what is first included inside of a condition is there under it alone

PLANE_SAMPLERS
#ifdef PUBLISHED
#include "gl/published_sums.glsl"
#endif

layout(binding = 0) uniform sampler2D background;  // scene-linear, premultiplied, and alpha
#ifndef NO_DEPTH
layout(binding = 5) uniform sampler2D opaqueZ;     // planar metres, +inf where nothing was hit
#endif
#ifndef NO_SOLIDS
layout(binding = 6) uniform sampler2D solid;       // nearest fragment that hides everything: rgb, planar z
#endif
#ifdef PART_OF_TEXTURE
uniform ivec2 pictureSize;
#endif

const float kNoDepth = 3e38f;

ivec2 inPicture(ivec2 pixel) {
#ifdef PART_OF_TEXTURE
  return clamp(pixel, ivec2(0), pictureSize - 1);
#else
  return clamp(pixel, ivec2(0), textureSize(background, 0) - 1);
#endif
}

vec4 solidAt(ivec2 pixel) {
#ifdef NO_SOLIDS
  return vec4(0.0f, 0.0f, 0.0f, intBitsToFloat(0x7f800000));
#else
  return texelFetch(solid, pixel, 0);
#endif
}

// Sums of W delta, W, s^2.
vec4 pathSumsAt(ivec2 pixel) {
#if defined(PUBLISHED)
  return publishedPath(publishedAt(pixel));
#elif defined(SCATTER)
  return texelFetch(refractionSum, pixel, 0);
#else
  return vec4(0.0f);
#endif
}

vec4 backdropColour(ivec2 pixel) {
  ivec2 place = inPicture(pixel);
  vec4 front = solidAt(place);
  return front.a < kNoDepth ? vec4(front.rgb, 1.0f) : texelFetch(background, place, 0);
}

float backdropDepth(ivec2 pixel) {
  ivec2 place = inPicture(pixel);
#ifdef NO_DEPTH
  return solidAt(place).a;
#else
  return min(texelFetch(opaqueZ, place, 0).r, solidAt(place).a);
#endif
}

// No pixel is known to hold two surfaces.
vec4 colourBehind(ivec2 pixel, float layerZ) { return backdropColour(pixel); }

float spreadAt(ivec2 pixel) { return pathSumsAt(inPicture(pixel)).w; }

#include "shared/gather.glsl"
#include "shared/path_lookup.glsl"
