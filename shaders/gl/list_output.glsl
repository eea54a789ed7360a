#pragma once
// Appends a fragment to its pixel's list: every pixel of the band owns a range that a first pass has counted.
#include "gl/frame.glsl"
#include "gl/fragment_record.glsl"
#include "gl/identity.glsl"
#include "shared/refraction.glsl"

layout(std430, binding = 3) writeonly buffer Fragments { FragmentRecord fragments[]; };
#ifdef DISPERSION
layout(std430, binding = 7) writeonly buffer Dispersions { vec4 dispersions[]; };  // one per fragment
#endif
layout(std430, binding = 4) buffer Cursors { uint cursors[]; };  // per pixel of the band: where its next fragment goes

void appendFragment(Layer layer, Scatter scatter, vec4 dispersion, ivec2 pixel) {
  FragmentRecord record;
  record.radiance = layer.radiance;
  record.coverage = layer.coverage;
  record.transmission = layer.transmission;
  record.z = layer.z;
  record.offset = scatter.offset;
  record.variance = scatter.variance;
  record.identity = identityOf(instanceIdentity, triangleNumber);
  ivec2 inBand = pixel - band.xy;
  uint place = atomicAdd(cursors[inBand.y * band.z + inBand.x], 1u);
  if (place >= uint(fragments.length())) return;
  fragments[place] = record;
#ifdef DISPERSION
  dispersions[place] = dispersion;
#endif
}
