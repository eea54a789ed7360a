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

const float PLD_MASK_FULL = 0.99999f;        // a mean of nothing but 1 may come out this far below it
const float PLD_MASK_SPREAD = 0.577f;        // texel over pixel at which a bilinear read spreads as the pixel does
const float PLD_MASK_REACH = 1.41421356f;    // of one of several passes, over its own edge

// Edge of what a sample of a levelled mask stands for, pixels. Those of several passes lie irregularly: each reaches
// into the gaps beside it, or a pattern that repeats with the pixels would be met at the same few places everywhere.
//   footprint  edge of the sample, 1 for the pixel's only one
PLD_FN float maskEdge(float footprint) {
  return footprint < 1.0f ? PLD_MASK_REACH * footprint : footprint;
}

// Mip level that holds what the cut leaves of a mask under a sample. Level 0 holds alpha itself.
//   texels  texelsAcross its maskEdge
PLD_FN float keptLevel(float texels, float footprint) {
  float spread = footprint < 1.0f ? 1.0f : PLD_MASK_SPREAD;
  return log2(max(spread * texels, 2.0f));
}

// Coverage of a sample on a mask: the cut at the sample where it resolves the texels, from two texels a sample on the
// mean of what the cut leaves of them. Both have the same mean, and so has every mixture.
//   atSample  by the cut there
//   kept      of the mip levels
//   texels    texelsAcross its maskEdge
PLD_FN float levelledCoverage(float atSample, float kept, float texels) {
  float left = rimLeft(texels);
  if (left >= 1.0f) return atSample;
  precise float covered = kept + (atSample - kept) * left;
  return covered >= PLD_MASK_FULL ? 1.0f : covered;
}
