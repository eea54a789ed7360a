#pragma once
// Coverage decided from the triangle's own corners, not from corners that the rasteriser has snapped to its sub-pixel
// grid (1/256 px on Mesa): a pixel centre 0.001 px from an edge falls on the side where it lies. The triangle is drawn
// a little larger than it is, with attributes extrapolated on its plane, and the fragment stage cuts it exactly; a
// shared edge belongs to one of its two triangles. How far a triangle is grown decides nothing, as long as it is far
// enough.
#ifdef EXACT_COVERAGE
const float kGrow = 0.0078125f;         // pixels outwards: twice the grid's worst error on either side
const float kGrowFar = 1.0f;            // the same where a rasteriser has to clip first
const float kLeastGrow = 0.0005f;       // pixels; where not even that much is possible, a corner stays
const float kLongestMitre = 0.5f;       // pixels; corners that grow farther do so in double precision
const float kLongestNeedle = 4096.0f;   // pixels; how far tips of needles grow
const float kLargestWindow = 32768.0f;  // pixels; beyond, float no longer resolves 1/256 px
const float kUncut = 3e38f;             // marks a triangle that cannot be cut: no number says where it lies

float crossOf(vec2 a, vec2 b) {
  precise float product = a.x * b.y - a.y * b.x;
  return product;
}
#endif
