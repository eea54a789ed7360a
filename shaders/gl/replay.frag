// Blends fragment number `turn` of every pixel's list, so that the blend order of a pixel is its list's order.
#include "gl/frame.glsl"
#include "gl/fragment_record.glsl"
#include "gl/sums_output.glsl"

layout(std430, binding = 3) readonly buffer Fragments { FragmentRecord fragments[]; };
#ifdef DISPERSION
layout(std430, binding = 7) readonly buffer Dispersions { vec4 dispersions[]; };
#endif
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
  Scatter scatter;
  scatter.offset = record.offset;
  scatter.variance = record.variance;
  vec4 dispersion = vec4(0.0f);
#ifdef DISPERSION
  dispersion = dispersions[place];
#endif
  writeScatter(layer, scatter, dispersion);
#endif
}
