#pragma once
// Depth as depth buffers hold it, in whichever convention, to planar distance.

// From the projection's rows: clip z = a v + b, clip w = c v + d, where v is view-space z.
struct DepthRows {
  float a, b, c, d;
};

// Planar distance in scene units, > 0; +inf where nothing is.
//   depth       window depth, [0,1]
//   clipScale, clipOffset  window depth to normalised depth: 1 and 0, or 2 and -1
//   empty       window depth of nothing: 1, or 0 where it is reversed
PLD_FN float planarFromDevice(DepthRows rows, float depth, float clipScale, float clipOffset, float empty) {
  float nothing = intBitsToFloat(0x7f800000);
  if (depth == empty) return nothing;
  precise float normalised = depth * clipScale + clipOffset;
  precise float over = rows.d * normalised - rows.b;
  precise float under = rows.a - rows.c * normalised;
  if (under == 0.0f) return nothing;
  precise float z = -(over / under);
  return z > 0.0f ? z : nothing;
}
