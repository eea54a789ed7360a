#pragma once
// The fragment stage's half of gl/exact_coverage.glsl.
#include "gl/exact_coverage.glsl"
#ifdef EXACT_COVERAGE
// The true corners: window pixels and 1, or, of a corner behind the eye or far outside, window pixels times w, and w;
// and planar depth.
layout(location = 5) flat in vec4 corner0;
layout(location = 6) flat in vec4 corner1;
layout(location = 8) flat in vec4 corner2;
layout(location = 9) flat in float winding;  // of them: 1 or -1; 0 covers nothing

const float kSideRounding = 4.8e-7f;  // of the products of which sideOf() takes the difference

// Which side of the line from a to b the pixel centre lies on; where float does not tell, in double.
float sideOf(vec3 a, vec3 b) {
  vec2 centre = gl_FragCoord.xy;
  if (a.z == 1.0f && b.z == 1.0f) {
    vec2 along = b.xy - a.xy, towards = centre - a.xy;
    float side = crossOf(along, towards);
    if (abs(side) > kSideRounding * (abs(along.x * towards.y) + abs(along.y * towards.x))) return side;
  }
  precise dvec2 from = dvec2(a.xy) - dvec2(centre) * double(a.z);
  precise dvec2 to = dvec2(b.xy) - dvec2(centre) * double(b.z);
  precise double side = from.x * to.y - from.y * to.x;
  return side > 0.0lf ? 1.0f : side < 0.0lf ? -1.0f : 0.0f;
}

// The same line gives the same side from either of its triangles; centres on it belong to one of them.
bool behindEdge(vec3 a, vec3 b) {
  bool swapped = a.x != b.x ? a.x > b.x : a.y != b.y ? a.y > b.y : a.z > b.z;
  float side = swapped ? sideOf(b, a) : sideOf(a, b);
  float inwards = swapped ? -winding : winding;
  return side == 0.0f ? inwards < 0.0f : side * inwards < 0.0f;
}

bool outsideTriangle() {
  if (corner0.x == kUncut) return false;
  return winding == 0.0f || behindEdge(corner0.xyz, corner1.xyz) || behindEdge(corner1.xyz, corner2.xyz) ||
         behindEdge(corner2.xyz, corner0.xyz);
}
#else
bool outsideTriangle() { return false; }
#endif
