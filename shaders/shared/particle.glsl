#pragma once
// A particle: a ball of even density, drawn as a disc that faces the camera. WB13 section 3.4.2 (soft particles scale C
// and alpha), PT17 section 7.2.
#include "shared/scattering.glsl"

// What of a ball a ray meets before something ends it.
struct Chord {
  float share;  // of the ball's diameter, [0,1]
  float z;      // middle of it, planar metres; the particle's own where all of it is seen
};

//   square  squared distance from the disc's middle, in radii, [0,1)
//   z       of the ball's middle, planar metres, > 0
//   radius  metres
//   zBehind of what is opaque, planar metres, +inf for nothing
// The share is linear in how far the surface stands behind the ball's front: no line shows where they meet.
PLD_FN Chord chordOf(float square, float z, float radius, float zBehind) {
  precise float reach = radius * sqrt(max(1.0f - square, 0.0f));
  float front = max(z - reach, 0.0f), back = min(z + reach, zBehind);
  Chord chord;
  chord.share = 0.0f;
  chord.z = z;
  if (!(reach > 0.0f) || !(back > front)) return chord;
  precise float share = (back - front) / (2.0f * radius);
  chord.share = min(share, 1.0f);
  if (front > 0.0f ? zBehind >= z + reach : false) return chord;
  precise float middle = 0.5f * (front + back);
  chord.z = middle;
  return chord;
}

// Coverage of a ball along a chord: its density is even, so that opacities of its parts multiply out to its own.
//   middle  coverage of the whole diameter, [0,1]
PLD_FN float ballCoverage(float middle, float share) {
  if (middle >= 1.0f && share >= 1.0f) return 1.0f;
  precise float depth = share * opticalDepth(middle, 1.0f - middle);
  return pldOneMinusExp(depth);
}

// A flat card: seen in full where what is behind it stands at least `softness` metres behind, WB13.
PLD_FN float cardShare(float z, float zBehind, float softness) {
  if (!(softness > 0.0f)) return 1.0f;
  precise float share = (zBehind - z) / softness;
  return clamp(share, 0.0f, 1.0f);
}
