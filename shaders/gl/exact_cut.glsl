#pragma once
// The fragment stage's half of gl/exact_coverage.glsl.
#include "gl/exact_coverage.glsl"
#ifdef EXACT_COVERAGE
layout(location = 5) flat in vec4 corners01;
layout(location = 6) flat in vec2 corner2;

// Which side of the line from a to b the pixel centre lies on: > 0 is where the triangle lies when `turn` is its
// winding. The same line gives the same number from either of its triangles; centres on it belong to one of them.
bool behindEdge(vec2 a, vec2 b, float turn) {
  bool swapped = a.x > b.x || (a.x == b.x && a.y > b.y);
  vec2 from = swapped ? b : a;
  vec2 to = swapped ? a : b;
  float side = crossOf(to - from, gl_FragCoord.xy - from);
  float inwards = swapped ? -turn : turn;
  return side == 0.0f ? inwards < 0.0f : side * inwards < 0.0f;
}

bool outsideTriangle() {
  if (corners01.x == kUncut) return false;
  float turn = crossOf(corners01.zw - corners01.xy, corner2 - corners01.xy) > 0.0f ? 1.0f : -1.0f;
  return behindEdge(corners01.xy, corners01.zw, turn) || behindEdge(corners01.zw, corner2, turn) ||
         behindEdge(corner2, corners01.xy, turn);
}
#else
bool outsideTriangle() { return false; }
#endif
