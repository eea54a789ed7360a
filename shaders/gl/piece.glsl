#pragma once
// The name of a fragment for random numbers: its triangle's, or, where PIECES, that of the piece of the triangle in the
// middle of the pixel. Mirrors pieceAt() in engine_bridge/embree/ray_fragments.cpp.
#include "gl/contact_depth.glsl"
#include "gl/frame.glsl"
#include "gl/identity.glsl"
#include "shared/piece.glsl"

#ifdef PIECES
// Barycentric coordinates of the second and the third corner where the triangle's plane passes a place of the window.
dvec2 cornerShares(dvec2 place) {
  dvec2 a = cornerFrom(place, corner0), b = cornerFrom(place, corner1), c = cornerFrom(place, corner2);
  dvec3 shares = dvec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
  double sum = shares.x + shares.y + shares.z;
  return sum == 0.0lf ? dvec2(0.0lf) : dvec2(shares.y, shares.z) / sum;
}

uint identityHere() {
  uint identity = identityOf(instanceIdentity, triangleNumber);
  if (corner0.x == kUncut) return pieceOf(identity, gl_FragCoord.xy, vec2(1.0f));
  // All passes of a picture mean the same piece.
  dvec2 middle = dvec2(gl_FragCoord.xy) + dvec2(toMiddle);
  dvec2 at = cornerShares(middle);
  vec2 right = vec2(cornerShares(middle + dvec2(1.0lf, 0.0lf)) - at);
  vec2 down = vec2(cornerShares(middle + dvec2(0.0lf, 1.0lf)) - at);
  return pieceOf(identity, vec2(at), vec2(length(vec2(right.x, down.x)), length(vec2(right.y, down.y))));
}
#else
uint identityHere() { return identityOf(instanceIdentity, triangleNumber); }
#endif
