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
