#pragma once
// Whether a fragment is in front of what is opaque, where the two touch.
#include "gl/exact_cut.glsl"
#include "gl/frame.glsl"

const float kTouching = 1e-4f;  // relative; interpolated depth is never off by so much

#ifdef EXACT_COVERAGE
// From the pixel centre to a corner, times the corner's w.
dvec2 cornerFrom(dvec2 centre, vec4 corner) {
  double w = orthographic != 0 ? 1.0lf : double(corner.w);
  return corner.z == 1.0f ? (dvec2(corner.xy) - centre) * w : dvec2(corner.xy) - centre * double(corner.z);
}

// Planar depth of the triangle at the pixel centre. Of a plane that is seen aslant the interpolated one is off by more
// than the opaque depth's precision.
float planeDepth(float interpolated) {
  if (corner0.x == kUncut) return interpolated;
  dvec2 centre = dvec2(gl_FragCoord.xy);
  dvec2 a = cornerFrom(centre, corner0), b = cornerFrom(centre, corner1), c = cornerFrom(centre, corner2);
  dvec3 shares = dvec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
  double sum = shares.x + shares.y + shares.z;
  return sum == 0.0lf ? interpolated : float(dot(shares, dvec3(corner0.w, corner1.w, corner2.w)) / sum);
}
#else
float planeDepth(float interpolated) { return interpolated; }
#endif

bool isBehind(float z, float opaque) {
  float limit = opaque * depthFactor;
  if (z < limit * (1.0f - kTouching)) return false;
  return z > limit * (1.0f + kTouching) || planeDepth(z) > limit;
}
