#pragma once
// Ambient occlusion at the partly covered rim of a cut-out surface, from its opaque neighbours. MODEL section 10;
// PT17 section 6 and listing 2. The caller fetches: for each tap, the neighbour's depth and occlusion at
// occlusionPixel, summed by occlusionTap, and in the end occlusionFrom.

const int PLD_OCCLUSION_RELATIVE = 0;   // depth compared relative to z, sky weighs nothing, no neighbour means open
const int PLD_OCCLUSION_PUBLISHED = 1;  // listing 2 as printed: 0.01 m, the pixel itself first, black where nothing weighs

const int PLD_LINE_TAPS = 12;
const float PLD_LINE_STRIDE = 1.0f;            // pixels; the nearest neighbours know most
const float PLD_PUBLISHED_STRIDE = 3.0f;       // pixels
const int PLD_BOX_RADIUS = 3;
const float PLD_BOX_STRIDE = 2.0f;  // pixels
const float PLD_FLAT_GRADIENT = 1e-4f;

// Depth difference at which a neighbour counts half: a part of z, or metres as published.
const float PLD_OCCLUSION_REACH = 0.01f;
// Weight below which the neighbours are not believed: half of a neighbour beside the rim and at its depth. Less moves
// the answer towards open, so that nothing flickers.
const float PLD_OCCLUSION_BELIEF = 0.5f;
// The published floor under the summed weights.
const float PLD_PUBLISHED_FLOOR = 0.01f;

// Where to look for neighbours.
struct OcclusionSearch {
  int taps;
  vec2 towards;  // unit, towards rising coverage, y down; 0 searches a box
};

// Partly covered: what a rim is.
PLD_FN bool isRim(float coverage) {
  return coverage > 0.0f && coverage < 1.0f;
}

// A surface that the opaque picture lacks: in front of it by more than neighbours at one depth differ. A z of infinity
// is nothing.
PLD_FN bool standsBefore(float z, float opaqueZ) {
  precise float bound = opaqueZ * (1.0f - PLD_OCCLUSION_REACH);
  return z < bound;
}

// The same surface, as far as depth tells.
PLD_FN bool isAtDepth(float opaqueZ, float z) {
  precise float apart = abs(opaqueZ - z);
  return apart <= PLD_OCCLUSION_REACH * z;
}

//   gradient  change of coverage per pixel, y down
PLD_FN OcclusionSearch occlusionSearch(vec2 gradient) {
  precise float x = gradient.x;
  precise float y = gradient.y;
  precise float steepness = sqrt(x * x + y * y);
  OcclusionSearch search;
  if (steepness < PLD_FLAT_GRADIENT) {
    search.taps = (2 * PLD_BOX_RADIUS + 1) * (2 * PLD_BOX_RADIUS + 1);
    search.towards = vec2(0.0f);
    return search;
  }
  precise vec2 towards = gradient / steepness;
  search.taps = PLD_LINE_TAPS;
  search.towards = towards;
  return search;
}

// Offset of a tap in pixels, y down.
PLD_FN vec2 occlusionOffset(OcclusionSearch search, int tap, int form) {
  if (search.taps == PLD_LINE_TAPS) {
    // The first published tap is the rim's own pixel, whose depth is the background's; ours starts beside it.
    float place = form == PLD_OCCLUSION_PUBLISHED ? float(tap) * PLD_PUBLISHED_STRIDE
                                                  : float(tap + 1) * PLD_LINE_STRIDE;
    precise vec2 along = search.towards * place;
    return along;
  }
  int edge = 2 * PLD_BOX_RADIUS + 1;
  int row = tap / edge;
  int dy = row - PLD_BOX_RADIUS;
  int dx = tap - row * edge - PLD_BOX_RADIUS;
  // Every other row half a stride aside, against a visible grid.
  int odd = (dy < 0 ? -dy : dy) & 1;
  precise float shift = float(odd) - 0.5f;
  vec2 offset;
  offset.x = (float(dx) + shift) * PLD_BOX_STRIDE;
  offset.y = float(dy) * PLD_BOX_STRIDE;
  return offset;
}

// The opaque pixel of a tap; both its depth and its occlusion come from there.
PLD_FN ivec2 occlusionPixel(ivec2 pixel, OcclusionSearch search, int tap, int form, ivec2 size) {
  vec2 offset = occlusionOffset(search, tap, form);
  precise vec2 place = vec2(pixel) + vec2(0.5f) + offset;
  ivec2 found = ivec2(floor(place));
  return max(min(found, size - ivec2(1)), ivec2(0));
}

// One neighbour: (weighted occlusion, weight).
//   occlusion  of the neighbour, [0,1], 1 = open
//   z          of the neighbour, planar metres, +inf where nothing was hit
//   zHere      of the rim, planar metres, > 0
PLD_FN vec2 occlusionTap(OcclusionSearch search, int tap, float occlusion, float z, float zHere, int form) {
  if (z > 1e30f) return vec2(0.0f);
  bool published = form == PLD_OCCLUSION_PUBLISHED;
  precise float reach = published ? PLD_OCCLUSION_REACH : PLD_OCCLUSION_REACH * zHere;
  // Along a line the farther neighbours only help out: pixels away another leaf begins.
  float away = published || search.taps != PLD_LINE_TAPS ? 1.0f : float(tap + 1);
  precise float weight = reach / ((reach + abs(zHere - z)) * away);
  precise vec2 weighted = vec2(occlusion * weight, weight);
  return weighted;
}

// The occlusion that the neighbours' sum means. [0,1], 1 = open
PLD_FN float occlusionFrom(vec2 sum, int form) {
  if (form == PLD_OCCLUSION_PUBLISHED) {
    precise float published = sum.x / max(sum.y, PLD_PUBLISHED_FLOOR);
    return clamp(published, 0.0f, 1.0f);
  }
  if (sum.y <= 0.0f) return 1.0f;
  precise float mean = sum.x / sum.y;
  precise float belief = min(sum.y * (1.0f / PLD_OCCLUSION_BELIEF), 1.0f);
  precise float occlusion = 1.0f - belief * (1.0f - mean);
  return clamp(occlusion, 0.0f, 1.0f);
}

// Light that a surface sends to the eye with its surroundings partly hidden.
//   direct, indirect  radiance, scene-linear; occlusion darkens the second fully and the first by directShare
PLD_FN vec3 occludedLight(vec3 direct, vec3 indirect, float occlusion, float directShare) {
  precise vec3 light = direct * (1.0f - directShare * (1.0f - occlusion)) + indirect * occlusion;
  return light;
}
