#pragma once
// Pieces of a triangle, each about a pixel large where it is seen: names for noise that moves, turns and bends with its
// object. After Wyman and McGuire, Hashed Alpha Testing (I3D 2017), whose cells are of object space; a triangle's own
// coordinates follow skins and morphs as well.
#include "shared/hash.glsl"

const float PLD_MOST_STRIPS = 1048576.0f;  // across a triangle; no coordinate in float resolves more
const float PLD_FARTHEST_STRIP = 1e9f;     // an int holds it

// Which strip of the triangle a coordinate lies in. A strip is .5 to 2 pixels wide; as the triangle comes nearer they
// halve one by one, so that the noise never changes everywhere at once.
//   at        barycentric coordinate
//   perPixel  how fast it changes along the picture
PLD_FN uint stripOf(uint identity, float at, float perPixel) {
  float across = perPixel > 1.0f / PLD_MOST_STRIPS ? max(1.0f / perPixel, 1.0f) : PLD_MOST_STRIPS;
  float strips = 1.0f;
  while (2.0f * strips <= across) strips = 2.0f * strips;
  precise float place = floor(at * strips);
  uint wide = hashOf(uint(strips) ^ hashOf(uint(int(abs(place) < PLD_FARTHEST_STRIP ? place : 0.0f))));
  precise float halved = (across / strips - 1.0f) * 16777216.0f;  // part of the strips, in 24 bits
  if (float(hashOf(identity ^ wide) >> 8u) >= halved) return wide;
  precise float narrow = floor(at * (2.0f * strips));
  return hashOf(uint(2.0f * strips) ^ hashOf(uint(int(abs(narrow) < PLD_FARTHEST_STRIP ? narrow : 0.0f))));
}

// A piece, named as identityOf() names the triangle.
//   at        two barycentric coordinates, of the second and the third corner
//   perPixel  lengths of their gradients in the picture
PLD_FN uint pieceOf(uint identity, vec2 at, vec2 perPixel) {
  uint second = stripOf(identity, at.x, perPixel.x), third = stripOf(hashOf(identity), at.y, perPixel.y);
  return hashOf(identity ^ hashOf(second ^ hashOf(third)));
}
