#pragma once
// What a place of the backdrop shows, sharp or spread by diffusion. Whoever includes this says where texels come from,
// by these functions of pixels or texels, whose coordinates are clamped to the picture by the callee:
//   vec4 backdropColour(ivec2 pixel)            scene-linear, premultiplied, and alpha; perhaps not finite
//   float backdropDepth(ivec2 pixel)            planar metres, +inf for nothing
//   vec4 colourBehind(ivec2 pixel, float layerZ)     the colour, for a layer that does not stand behind the pixel's depth
//   float spreadAt(ivec2 pixel)                 D^2, pixels^2
//   SpreadTexel spreadTexel(int level, ivec2 texel)  of the pyramid, level >= 1
//   SpreadBody spreadBody(int level, ivec2 texel)    its sums alone
#include "shared/spread_pyramid.glsl"

struct LookupChoice {
  int kernel;           // PLD_DIFFUSE_*
  int exact;            // not 0: every tap of the Gaussian, at a cost that grows as D^2
  float largestSpread;  // the data window's diagonal, pixels
  int levels;           // of the pyramid; 0 for none
};

// The sum of a gather, and what its rounding has lost so far: thousands of taps of a constant must give that constant.
// Nothing passed when weight is 0.
struct Gathered {
  vec4 colour, lostColour;
  float weight, lostWeight;
};

PLD_FN Gathered nothingGathered() {
  Gathered none;
  none.colour = vec4(0.0f);
  none.lostColour = vec4(0.0f);
  none.weight = 0.0f;
  none.lostWeight = 0.0f;
  return none;
}

PLD_FN Gathered addTap(Gathered sum, vec4 colour, float weight) {
  precise vec4 colourTerm = colour - sum.lostColour;
  precise float weightTerm = weight - sum.lostWeight;
  precise vec4 colourSum = sum.colour + colourTerm;
  precise float weightSum = sum.weight + weightTerm;
  precise vec4 lostColour = (colourSum - sum.colour) - colourTerm;
  precise float lostWeight = (weightSum - sum.weight) - weightTerm;
  sum.colour = colourSum;
  sum.lostColour = lostColour;
  sum.weight = weightSum;
  sum.lostWeight = lostWeight;
  return sum;
}

PLD_FN bool isFiniteColour(vec4 colour) {
  return abs(colour.r) < 3e38f && abs(colour.g) < 3e38f && abs(colour.b) < 3e38f && abs(colour.a) < 3e38f;
}

// What a tap may show: finite, and not in front of the layer at `layerZ`.
PLD_FN bool tapShows(ivec2 pixel, vec4 colour, float layerZ) {
  return isFiniteColour(colour) && !standsInFront(backdropDepth(pixel), layerZ);
}

// For the layers of a pixel. What the eye sees straight behind them is never in front of them, whatever depth the
// pixel's centre has: it leans, and is rounded, while the layers are met where a pass samples the pixel.
//   position  pixels, +0.5 at a pixel's centre
//   own       what the pixel itself shows straight behind its layers
PLD_FN Gathered gatherBilinear(vec2 position, float layerZ, ivec2 ownPixel, vec4 own) {
  Footprint footprint = footprintAt(position);
  Gathered sum = nothingGathered();
  for (int k = 0; k < 4; ++k) {
    ivec2 pixel = ivec2(footprint.first.x + (k & 1), footprint.first.y + (k >> 1));
    float share = footprint.share[k];
    if (share <= 0.0f) continue;
    bool straight = pixel.x == ownPixel.x && pixel.y == ownPixel.y;
    vec4 colour = straight ? own : colourBehind(pixel, layerZ);
    if (!isFiniteColour(colour) || (!straight && standsInFront(backdropDepth(pixel), layerZ))) continue;
    precise vec4 colourSum = sum.colour + share * colour;
    precise float weightSum = sum.weight + share;
    sum.colour = colourSum;
    sum.weight = weightSum;
  }
  return sum;
}

// Every pixel within reach. Cost grows as D^2.
PLD_FN Gathered gatherGaussian(vec2 centre, float spread, float layerZ) {
  float reach2 = PLD_GAUSSIAN_REACH * PLD_GAUSSIAN_REACH;
  precise float variance = spread * spread;
  precise float radius = PLD_GAUSSIAN_REACH * spread;
  int x0 = int(ceil(centre.x - radius - 0.5f)), x1 = int(floor(centre.x + radius - 0.5f));
  int y0 = int(ceil(centre.y - radius - 0.5f)), y1 = int(floor(centre.y + radius - 0.5f));
  Gathered sum = nothingGathered();
  for (int y = y0; y <= y1; ++y) {
    precise float dy = float(y) + 0.5f - centre.y;
    Gathered row = nothingGathered();
    for (int x = x0; x <= x1; ++x) {
      ivec2 pixel = ivec2(x, y);
      precise float dx = float(x) + 0.5f - centre.x;
      precise float r2 = dx * dx + dy * dy;
      if (!tapCounts(r2, variance, spreadAt(pixel), reach2)) continue;
      vec4 colour = backdropColour(pixel);
      if (!tapShows(pixel, colour, layerZ)) continue;
      float weight = gaussianWeight(r2, variance);
      precise vec4 part = weight * colour;
      row = addTap(row, part, weight);
    }
    sum = addTap(sum, row.colour, row.weight);
  }
  return sum;
}

// PT17 listing 3: taps two pixels apart, sixteen pixels away at most.
PLD_FN Gathered gatherDisc(vec2 centre, float variance, float layerZ) {
  int most = int(min(sqrt(variance), PLD_DISC_LARGEST)) / PLD_DISC_STRIDE * PLD_DISC_STRIDE;
  ivec2 middle = ivec2(int(floor(centre.x)), int(floor(centre.y)));
  Gathered sum = nothingGathered();
  for (int j = -most; j <= most; j += PLD_DISC_STRIDE)
    for (int i = -most; i <= most; i += PLD_DISC_STRIDE) {
      ivec2 pixel = middle + ivec2(i, j);
      float tapVariance = spreadAt(pixel);
      if (tapVariance <= 0.0f || !tapCounts(float(i * i + j * j), variance, tapVariance, 1.0f)) continue;
      vec4 colour = backdropColour(pixel);
      if (!tapShows(pixel, colour, layerZ)) continue;
      float weight = discWeight(tapVariance);
      precise vec4 colourSum = sum.colour + weight * colour;
      precise float weightSum = sum.weight + weight;
      sum.colour = colourSum;
      sum.weight = weightSum;
    }
  return sum;
}

// A pixel of the picture, for the first level: empty when it does not diffuse.
PLD_FN SpreadTexel diffusingPixel(ivec2 pixel) {
  float variance = spreadAt(pixel);
  vec4 colour = backdropColour(pixel);
  if (variance <= 0.0f || !isFiniteColour(colour)) return emptySpreadTexel();
  return spreadPixel(colour, backdropDepth(pixel), variance);
}

// A texel of a level from the texels, or pixels, below it.
PLD_FN SpreadTexel halvedTexel(int level, ivec2 texel) {
  SpreadTexel sum = emptySpreadTexel();
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      ivec2 below = ivec2(2 * texel.x - 1 + i, 2 * texel.y - 1 + j);
      float share = spreadMask(i) * spreadMask(j);
      if (level == 1)
        sum = addSpread(sum, diffusingPixel(below), share);
      else
        sum = addSpread(sum, spreadTexel(level - 1, below), share);
    }
  return sum;
}

// The same as passingPart() of a texel taken apart: its parts are asked one by one, at their own distance.
PLD_FN SpreadBody passingParts(int level, ivec2 texel, vec2 centre, float rateLimit) {
  float edge = 0.5f * float(1 << level);
  SpreadBody sum = emptySpreadTexel().body;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      ivec2 below = ivec2(2 * texel.x - 1 + i, 2 * texel.y - 1 + j);
      precise vec2 offset = vec2(float(below.x) + 0.5f, float(below.y) + 0.5f) * edge - centre;
      precise float away = sqrt(offset.x * offset.x + offset.y * offset.y);
      SpreadBody part;
      if (level == 1) {
        part = diffusingPixel(below).body;
        if (part.mass <= 0.0f || part.mostRate > rateLimit || part.leastReach < away) continue;
      } else {
        part = spreadBody(level - 1, below);
        if (part.mass <= 0.0f) continue;
        if (part.mostRate > rateLimit || part.leastReach < away + PLD_SPREAD_PARTS * edge)
          part = passingPart(spreadTexel(level - 1, below), away, edge, rateLimit);
      }
      float share = spreadMask(i) * spreadMask(j);
      precise vec4 colour = sum.colour + share * part.colour;
      precise float mass = sum.mass + share * part.mass;
      sum.colour = colour;
      sum.mass = mass;
    }
  return sum;
}

// The Gaussian over the pyramid's texels: a number of them that no spread changes. What their footprints have spread
// already is left out of the weights.
PLD_FN Gathered gatherPyramid(int level, vec2 centre, float spread, float layerZ) {
  float edge = float(1 << level);
  precise vec2 place = centre / edge;
  precise float variance = spread * spread / (edge * edge);
  precise float weightVariance = variance - 0.25f * (1.0f - 1.0f / (edge * edge));
  precise float radius = PLD_GAUSSIAN_REACH * sqrt(variance);
  precise float most2 = radius * radius;
  precise float tailReach = PLD_SPREAD_TAIL * PLD_GAUSSIAN_REACH * spread;
  float rateLimit = 1.0f / max(PLD_IN_FRONT * layerZ, 1e-30f);
  float fine = level <= 2 ? PLD_SPREAD_FINE : PLD_SPREAD_COARSE;
  int x0 = int(ceil(place.x - radius - 0.5f)), x1 = int(floor(place.x + radius - 0.5f));
  int y0 = int(ceil(place.y - radius - 0.5f)), y1 = int(floor(place.y + radius - 0.5f));
  x1 = min(x1, x0 + PLD_SPREAD_TAPS - 1);
  float across[PLD_SPREAD_TAPS];
  for (int x = x0; x <= x1; ++x) {
    precise float dx = float(x) + 0.5f - place.x;
    across[x - x0] = gaussianWeight(dx * dx, weightVariance);
  }
  Gathered sum = nothingGathered();
  for (int y = y0; y <= y1; ++y) {
    precise float dy = float(y) + 0.5f - place.y;
    Gathered row = nothingGathered();
    float down = gaussianWeight(dy * dy, weightVariance);
    for (int x = x0; x <= x1; ++x) {
      precise float dx = float(x) + 0.5f - place.x;
      precise float r2 = dx * dx + dy * dy;
      if (r2 > most2) continue;
      ivec2 texel = ivec2(x, y);
      SpreadBody body = spreadBody(level, texel);
      if (body.mass <= 0.0f) continue;
      float weight = across[x - x0];
      precise float away = edge * sqrt(r2);
      if (!passesWhole(body, away, edge, tailReach, rateLimit)) {
        if (body.leastRate > rateLimit || body.mostReach <= away - PLD_SPREAD_PARTS * edge) continue;
        if (weight * down < fine || !isCut(body, away, edge))
          body = passingPart(spreadTexel(level, texel), away, edge, rateLimit);
        else
          body = passingParts(level, texel, centre, rateLimit);
      }
      precise vec4 colourSum = row.colour + weight * body.colour;
      precise float weightSum = row.weight + weight * body.mass;
      row.colour = colourSum;
      row.weight = weightSum;
    }
    precise vec4 rowColour = down * row.colour;
    precise float rowWeight = down * row.weight;
    sum = addTap(sum, rowColour, rowWeight);
  }
  return sum;
}

PLD_FN Gathered gatherSpread(LookupChoice settings, vec2 centre, float variance, float layerZ) {
  if (settings.kernel == PLD_DIFFUSE_DISC) return gatherDisc(centre, variance, layerZ);
  float spread = kernelSpread(variance, settings.largestSpread);
  int level = settings.exact != 0 ? 0 : min(spreadLevel(spread), settings.levels);
  if (level == 0) return gatherGaussian(centre, spread, layerZ);
  return gatherPyramid(level, centre, spread, layerZ);
}
