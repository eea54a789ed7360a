// Blends fragment number `turn` of every pixel's list, so that the blend order of a pixel is its list's order.
#define REPLAY
#include "gl/frame.glsl"
#include "gl/fragment_record.glsl"
#include "gl/scattered.glsl"
#include "gl/sums_output.glsl"

layout(std430, binding = 3) readonly buffer Fragments { FragmentRecord fragments[]; };
layout(std430, binding = 4) readonly buffer Offsets { uint offsets[]; };

uniform uint turn;

void main() {
  ivec2 inBand = ivec2(gl_FragCoord.xy) - band.xy;
  int pixel = inBand.y * band.z + inBand.x;
  uint place = offsets[pixel] + turn;
  if (place >= offsets[pixel + 1]) discard;
  FragmentRecord record = fragments[place];
  Layer layer;
  layer.radiance = record.radiance;
  layer.coverage = record.coverage;
  layer.transmission = record.transmission;
  layer.z = record.z;
  WeightSettings settings;
  settings.kind = WEIGHT;
  settings.rangeNear = weightNear;
  settings.rangeFar = weightFar;
  settings.exponent = weightExponent;
  settings.reference = weightReference;
  writeSums(layer, settings);
#ifdef SCATTER
  Scattered here = withColumns(scattersNothing(), place);
  here.scatter.offset = record.offset;
  here.scatter.variance = record.variance;
  WRITE_SCATTERED(layer, here);
#endif
}
