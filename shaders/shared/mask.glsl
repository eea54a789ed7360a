#pragma once
// How textures are read whose alpha counts: colours weighted by it, and masks that are finer than a sample.

// A colour that was filtered weighted by its alpha, as stored times alpha: what is clear has none to give.
PLD_FN vec4 unweighted(vec4 weighted) {
  if (!(weighted.a > 0.0f)) return vec4(0.0f);
  precise float r = weighted.r / weighted.a;
  precise float g = weighted.g / weighted.a;
  precise float b = weighted.b / weighted.a;
  return vec4(r, g, b, weighted.a);
}

// Texels of a texture that lie beside one another under a sample's edge.
//   dx, dy  of texture coordinates in texels, from pixel to pixel
//   edge    of the sample, pixels
PLD_FN float texelsAcross(vec2 dx, vec2 dy, float edge) {
  precise float x = dx.x * dx.x + dx.y * dx.y;
  precise float y = dy.x * dy.x + dy.y * dy.y;
  precise float across = sqrt(max(x, y)) * edge;
  return across;
}

// How much of the width of a mask's rim is left where a sample meets texels of the finest level: all of it up to one
// texel a sample, nothing from two on. Between such samples alpha says nothing of what lies there; the alpha test alone
// is right in the mean.
//   texels  texelsAcross
PLD_FN float rimLeft(float texels) {
  return clamp(2.0f - texels, 0.0f, 1.0f);
}

// Edge of a square with as many texels as lie under a sample. A surface seen aslant has more of them one way than the
// other; its pattern is lost where this edge says so.
//   dx, dy, edge  as of texelsAcross
PLD_FN float texelsUnder(vec2 dx, vec2 dy, float edge) {
  precise float area = dx.x * dy.y - dx.y * dy.x;
  precise float under = sqrt(abs(area)) * edge;
  return under;
}

// How many mip levels a sample lies beyond the coarsest that holds a mask's pattern.
//   texels    of the finest level along its edge
//   resolved  that level
PLD_FN float levelsBeyond(float texels, float resolved) {
  return log2(max(texels, 1e-6f)) - resolved;
}

// Part of such a sample's coverage that the cut gives, at the level that holds it: all of it there, nothing from half a
// level on. Both have the same mean, and so has every mixture.
PLD_FN float cutLeft(float beyond) {
  return clamp(1.0f - 2.0f * beyond, 0.0f, 1.0f);
}

// Samples of several passes lie irregularly: each takes texels twice its own width, or a pattern that repeats with the
// pixels would be met at the same few places everywhere.
const float PLD_MASK_REACH = 2.0f;

// Mip level that holds what the cut leaves of a mask under such a sample.
//   footprint  edge of the sample, 1 for the pixel's only one
PLD_FN float keptLevel(float texels, float resolved, float footprint) {
  float reach = footprint < 1.0f ? PLD_MASK_REACH : 1.0f;
  return max(log2(max(reach * texels, 1e-6f)), resolved + 1.0f);
}

const float PLD_MASK_FULL = 0.99999f;  // a filtered mean of nothing but 1 may come out this far below it

//   atSample  coverage by the cut
//   kept      of the level that holds what the cut leaves
//   left      cutLeft
PLD_FN float partialCoverage(float atSample, float kept, float left) {
  precise float covered = kept + (atSample - kept) * left;
  return covered >= PLD_MASK_FULL ? 1.0f : covered;
}
