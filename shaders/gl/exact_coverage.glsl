#pragma once
// Coverage decided from the triangle's own corners in float, not from corners that the rasteriser has snapped to its
// sub-pixel grid (1/256 px on Mesa): a pixel centre 0.001 px from an edge falls on the side where it lies. The triangle is
// drawn a little larger than it is, with attributes extrapolated on its plane, and the fragment stage cuts it exactly;
// a shared edge belongs to one of its two triangles.
#ifdef EXACT_COVERAGE
const float kGrow = 0.0078125f;       // pixels outwards: twice the grid's worst error on either side
const float kLongestMitre = 0.5f;     // pixels: needles grow no farther at their tips
const float kLargestWindow = 32768.0f;  // pixels; beyond, float no longer resolves 1/256 px
const float kUncut = 3e38f;           // marks a triangle left to the rasteriser

float crossOf(vec2 a, vec2 b) {
  precise float product = a.x * b.y - a.y * b.x;
  return product;
}
#endif
