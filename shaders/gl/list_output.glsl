#pragma once
// Appends a fragment to its pixel's list, at the pixel's cursor: the places that it owns are counted before or checked
// after. Records are pairs of words: LeanFragment of gbuffer/lean_lists.h where LEAN, else Fragment of
// gbuffer/fragments.h.
#include "gl/frame.glsl"
#include "gl/piece.glsl"
#include "gl/scattered.glsl"

#ifdef LEAN
const uint kPairs = 4u;
#else
const uint kPairs = 6u;
#endif
// Software devices store 64 bits as quickly as 32.
#ifdef GL_ARB_gpu_shader_int64
layout(std430, binding = 3) writeonly buffer Fragments { uint64_t pairs[]; };
void storePair(uint place, uvec2 words) {
  pairs[place] = packUint2x32(words);
}
#else
layout(std430, binding = 3) writeonly buffer Fragments { uvec2 pairs[]; };
void storePair(uint place, uvec2 words) {
  pairs[place] = words;
}
#endif
void storePair(uint place, vec2 words) {
  storePair(place, floatBitsToUint(words));
}

layout(std430, binding = 4) buffer Cursors { uint cursors[]; };  // per pixel of the band: where its next fragment goes

void appendFragment(Layer layer, Scattered here, ivec2 pixel) {
  ivec2 inBand = pixel - band.xy;
  uint place = atomicAdd(cursors[inBand.y * band.z + inBand.x], 1u);
  uint first = place * kPairs;
  if (first + kPairs > uint(pairs.length())) return;
  storePair(first, layer.radiance.rg);
  storePair(first + 1u, vec2(layer.radiance.b, layer.coverage));
  storePair(first + 2u, layer.transmission.rg);
  storePair(first + 3u, vec2(layer.transmission.b, layer.z));
#ifndef LEAN
  storePair(first + 4u, here.scatter.offset);
  storePair(first + 5u, uvec2(floatBitsToUint(here.scatter.variance), identityHere()));
#endif
  storeColumns(place, here);
}
