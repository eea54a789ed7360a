#pragma once
// The backdrop at coarser and coarser resolution, so that a wide Gaussian reads few texels. Each level halves the last
// with the mask (1 3 3 1)/8 in both axes: its texels' footprints tend to quadratic B-splines, of which a Gaussian's
// samples make a Gaussian again. Texels hold sums over the diffusing pixels alone, so what is not seen through the glass
// does not leak into it.
#include "shared/diffusion.glsl"

// Texels beyond the picture whose footprint still reaches into it: coarser levels are that much wider on either side.
const int PLD_SPREAD_MARGIN = 2;
// Texels in a standard deviation, at least. Measured in tests/scatter/diffusion_test.cpp
const float PLD_TEXELS_PER_SPREAD = 2.0f;
const int PLD_SPREAD_TAPS = 36;  // across a kernel at most: less than four texels in a deviation, times its reach
// A tap that reaches this part of the kernel's way, or farther, leaves out less than 0.3% of it.
const float PLD_SPREAD_TAIL = 0.866f;
// Parts of the centre's weight below which a tap is not taken apart: on the first two levels, on the others.
const float PLD_SPREAD_FINE = 0.15f;
const float PLD_SPREAD_COARSE = 0.5f;
// How far from a texel's centre its pixels reach, texels: where a cut begins and ends.
const float PLD_SPREAD_PARTS = 0.75f;

// Sums over the diffusing pixels, and what decides whether they are seen.
struct SpreadBody {
  vec4 colour;
  float mass;           // of their weights, [0,1]
  float leastReach;     // how far the least spread of them reaches, pixels
  float mostReach;
  float leastRate;      // smallest 1 / depth, 0 for sky
  float mostRate;
};

// How reach and 1 / depth are spread over a texel. Two sorts of pixels (a pane's and those beside it, a lamp and the wall
// behind) are told apart exactly by these moments, as is what each sort contributes to the colour.
struct SpreadTexel {
  SpreadBody body;
  vec4 reachColour;  // sum of colour times reach
  vec4 rateColour;
  float reachMass;   // sum of mass times reach
  float rateMass;
};

// The level that a spread reads; 0 is the picture itself, which the pyramid does not hold.
//   spread  standard deviation, pixels
PLD_FN int spreadLevel(float spread) {
  int level = 0;
  for (float edge = 2.0f; edge * PLD_TEXELS_PER_SPREAD <= spread && level < 24; edge = edge * 2.0f) level = level + 1;
  return level;
}

// How far a kernel reaches, pixels.
PLD_FN float reachOf(float variance) {
  precise float reach = PLD_GAUSSIAN_REACH * sqrt(variance);
  return reach;
}

PLD_FN SpreadTexel emptySpreadTexel() {
  SpreadTexel texel;
  texel.body.colour = vec4(0.0f);
  texel.body.mass = 0.0f;
  texel.body.leastReach = 3e38f;
  texel.body.mostReach = 0.0f;
  texel.body.leastRate = 3e38f;
  texel.body.mostRate = 0.0f;
  texel.reachColour = vec4(0.0f);
  texel.rateColour = vec4(0.0f);
  texel.reachMass = 0.0f;
  texel.rateMass = 0.0f;
  return texel;
}

// A pixel of the picture as a texel.
//   colour    of the backdrop, finite
//   depth     planar metres, +inf for nothing
//   variance  D^2, > 0
PLD_FN SpreadTexel spreadPixel(vec4 colour, float depth, float variance) {
  precise float rate = 1.0f / max(depth, 1e-30f);
  float reach = reachOf(variance);
  precise vec4 byReach = reach * colour;
  precise vec4 byRate = rate * colour;
  SpreadTexel texel;
  texel.body.colour = colour;
  texel.body.mass = 1.0f;
  texel.body.leastReach = reach;
  texel.body.mostReach = reach;
  texel.body.leastRate = rate;
  texel.body.mostRate = rate;
  texel.reachColour = byReach;
  texel.rateColour = byRate;
  texel.reachMass = reach;
  texel.rateMass = rate;
  return texel;
}

// (1 3 3 1)/8
PLD_FN float spreadMask(int place) {
  return place == 0 || place == 3 ? 0.125f : 0.375f;
}

PLD_FN SpreadTexel addSpread(SpreadTexel sum, SpreadTexel part, float share) {
  if (part.body.mass <= 0.0f) return sum;
  precise vec4 colour = sum.body.colour + share * part.body.colour;
  precise float mass = sum.body.mass + share * part.body.mass;
  precise vec4 reachColour = sum.reachColour + share * part.reachColour;
  precise vec4 rateColour = sum.rateColour + share * part.rateColour;
  precise float reachMass = sum.reachMass + share * part.reachMass;
  precise float rateMass = sum.rateMass + share * part.rateMass;
  SpreadTexel result;
  result.body.colour = colour;
  result.body.mass = mass;
  result.body.leastReach = min(sum.body.leastReach, part.body.leastReach);
  result.body.mostReach = max(sum.body.mostReach, part.body.mostReach);
  result.body.leastRate = min(sum.body.leastRate, part.body.leastRate);
  result.body.mostRate = max(sum.body.mostRate, part.body.mostRate);
  result.reachColour = reachColour;
  result.rateColour = rateColour;
  result.reachMass = reachMass;
  result.rateMass = rateMass;
  return result;
}

// Part of those pixels of a texel that reach as far which lie within their reach of the centre: their places are spread
// over the texel, so the reach cuts it bit by bit. [0,1]
//   away  from the centre to the texel's, pixels
//   edge  of the texel, pixels
PLD_FN float withinReach(float reach, float away, float edge) {
  precise float part = (reach - away) * (0.5f / (PLD_SPREAD_PARTS * edge)) + 0.5f;
  return clamp(part, 0.0f, 1.0f);
}

// Whether all of the texel is seen.
//   tailReach  what reaches as far leaves out nothing to speak of
//   rateLimit  1 / depth of the nearest that is seen
PLD_FN bool passesWhole(SpreadBody body, float away, float edge, float tailReach, float rateLimit) {
  if (body.mostRate > rateLimit) return false;
  return body.leastReach >= tailReach || body.leastReach >= away + PLD_SPREAD_PARTS * edge;
}

// Whether the reach of some of the texel's pixels ends within it.
PLD_FN bool isCut(SpreadBody body, float away, float edge) {
  float before = away - PLD_SPREAD_PARTS * edge, behind = away + PLD_SPREAD_PARTS * edge;
  return (body.leastReach > before && body.leastReach < behind) || (body.mostReach > before && body.mostReach < behind);
}

// What of a texel is spread far enough, and lies far enough away.
PLD_FN SpreadBody passingPart(SpreadTexel texel, float away, float edge, float rateLimit) {
  SpreadBody body = texel.body;
  vec4 none = min(body.colour, vec4(0.0f)), all = max(body.colour, vec4(0.0f));
  vec4 colour = body.colour;
  float mass = body.mass;
  float low = withinReach(body.leastReach, away, edge);
  if (low < 1.0f) {
    float high = withinReach(body.mostReach, away, edge);
    float mostMass = body.mass;
    vec4 mostColour = body.colour;
    if (body.leastReach < body.mostReach) {
      // With the least and the most alone: sum = low + high, moment = least low + most high.
      precise float span = 1.0f / (body.mostReach - body.leastReach);
      precise float highMass = (texel.reachMass - body.leastReach * body.mass) * span;
      precise vec4 highColour = (texel.reachColour - body.leastReach * body.colour) * span;
      // Rounding, and a third value, must not make more light than there is.
      mostMass = clamp(highMass, 0.0f, body.mass);
      mostColour = clamp(highColour, none, all);
    }
    precise vec4 seenColour = low * (body.colour - mostColour) + high * mostColour;
    precise float seenMass = low * (body.mass - mostMass) + high * mostMass;
    colour = seenColour;
    mass = seenMass;
  }
  if (body.mostRate > rateLimit) {
    float nearMass = body.mass;
    vec4 nearColour = body.colour;
    if (body.leastRate < body.mostRate && rateLimit >= body.leastRate) {
      precise float span = 1.0f / (body.mostRate - body.leastRate);
      precise float frontMass = (texel.rateMass - body.leastRate * body.mass) * span;
      precise vec4 frontColour = (texel.rateColour - body.leastRate * body.colour) * span;
      nearMass = clamp(frontMass, 0.0f, body.mass);
      nearColour = clamp(frontColour, none, all);
    }
    precise float kept = mass / body.mass;
    precise vec4 farColour = kept * (body.colour - nearColour);
    precise float farMass = kept * (body.mass - nearMass);
    colour = farColour;
    mass = farMass;
  }
  body.colour = colour;
  body.mass = mass;
  return body;
}
