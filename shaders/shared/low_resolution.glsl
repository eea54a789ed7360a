#pragma once
// Layers that were drawn at low resolution, brought to full resolution: each texel is resolved first, so that what is
// interpolated is light and transmission, never raw sums. WB13 section 3.4.2, MODEL section 7
#include "shared/refraction.glsl"
#include "shared/resolve.glsl"

const int PLD_UPSAMPLE_REACH = 3;           // texels on either side: 7 x 7
const float PLD_UPSAMPLE_TENT = 1.25f;      // half width of the tent, texels; measured in tests/lowres
const float PLD_UPSAMPLE_WIDE = 1e-3f;      // share of the 7 x 7 tent, which counts where nothing nearer fits
const float PLD_UPSAMPLE_ENOUGH = 0.1f;     // sum of the near shares from which on it does not count
const float PLD_UPSAMPLE_TOLERANCE = 0.05f; // relative difference in depth that halves a texel twice
const float PLD_UPSAMPLE_LEAST = 1e-6f;     // what is left of a texel at quite another depth

// Where a pixel lies among texels, whose samples lie at whole numbers.
//   pixel  its corner; `inside` of pixels and texels both are sampled; scale: texels a pixel
PLD_FN vec2 placeInTexels(vec2 pixel, vec2 inside, float scale) {
  precise vec2 place = (pixel + inside) * scale - inside;
  return place;
}

// A low-resolution texel, resolved.
struct LowTexel {
  vec3 radiance;      // premultiplied: (1 - beta) U + V E, >= 0
  vec3 opacity;       // 1 - beta, [0,1]
  float weight;       // that its layers have together, as one of opacity 1 - beta: sum of w o over mean(1 - beta)
  float depthWeight;  // the same of w_z, of all that shows
  float z;            // mean planar z of what shows, metres
  float nearestZ;     // nearest layer, planar metres, +inf for none
};

//   solid     nearest fragment that hides everything: rgb, planar z, +inf for none. It is the last layer here
//   nearestZ  of the layers, +inf for none
PLD_FN LowTexel lowTexelOf(OitSums sums, vec4 solid, float nearestZ, WeightSettings settings) {
  Resolved resolved = resolveSums(sums, false);
  float hidden = meanOf(sums.opacity), light = meanOf(sums.light), shown = hidden + light;
  precise float weightSum = meanOf(sums.denominator);
  precise float depthSum = sums.opacityWeight + sums.lightWeight;
  precise float zSum = sums.opacityZ;
  precise float hiddenSum = hidden;
  LowTexel texel;
  texel.radiance = resolved.transparent;
  texel.opacity = netOpacityOf(sums.depth, transmittanceOf(sums.depth));
  texel.nearestZ = nearestZ;
  if (solid.a < 3e38f) {
    texel.radiance = overBackground(resolved, vec3(solid));
    texel.opacity = vec3(1.0f);
    texel.nearestZ = min(nearestZ, solid.a);
    weightSum = weightSum + layerWeight(settings, solid.a, 1.0f);
    depthSum = depthSum + depthWeight(settings, solid.a);
    zSum = zSum + solid.a;
    hiddenSum = hiddenSum + 1.0f;
    shown = shown + 1.0f;
  }
  // What only adds light keeps no depth in its sums but its nearest.
  texel.z = hiddenSum > 0.0f ? zSum / hiddenSum : min(nearestZ, 3e38f);
  // Not over the sum of o: with this weight the texel adds to the sums what its layers would have added.
  float net = meanOf(texel.opacity);
  texel.weight = net > 0.0f ? min(weightSum / net, 1e30f) : 0.0f;
  texel.depthWeight = shown > 0.0f ? depthSum / shown : 0.0f;
  return texel;
}

const float PLD_UPSAMPLE_CONTACT = 1e-4f;  // relative difference in depth that is none, where nothing tells it better

const float PLD_UPSAMPLE_CORNERS = 1.0f / 256.0f;  // texels: the grid on which a rasteriser puts corners

// How a pixel's opaque surface goes on around it, as the depths around tell.
struct SurfaceNear {
  vec2 change;   // per pixel of what is linear, as a part of its value at the pixel
  vec2 bend;     // of that, per pixel
  bool inverse;  // 1/z is linear, as with perspective; else z
};

// Change and bend along one axis, of the three neighbours in a row that bend least; a bend of 1 where none go on,
// neither straight nor with one bend.
//   around  2 and 1 pixels before, 1 and 2 after, as parts of the pixel's own value
PLD_FN vec2 changeAlong(vec4 around) {
  precise float left = around.x - 2.0f * around.y + 1.0f;
  precise float middle = around.y - 2.0f + around.z;
  precise float right = 1.0f - 2.0f * around.z + around.w;
  precise float across = 0.5f * (around.z - around.y);
  vec2 found = vec2(across, abs(middle));
  if (abs(left) < found.y) found = vec2(1.0f - around.y, abs(left));
  if (abs(right) < found.y) found = vec2(around.z - 1.0f, abs(right));
  bool straight = found.y <= 0.25f * abs(found.x) + 2e-6f;
  bool round_ = min(abs(left - middle), abs(right - middle)) <= 0.5f * abs(middle) && abs(middle) < 0.01f;
  return straight || round_ ? found : vec2(0.0f, 1.0f);
}

//   depths  planar metres; 0 outside of the picture
PLD_FN vec4 partsOf(float own, vec4 depths, bool inverse) {
  vec4 parts = vec4(0.0f);
  for (int i = 0; i < 4; ++i) {
    bool there = depths[i] > 0.0f;
    precise float part = inverse ? own / depths[i] : depths[i] / own;
    parts[i] = there ? min(part, 1e6f) : 1e6f;
  }
  return parts;
}

//   own     of the pixel, planar metres, finite
//   across  2 and 1 pixels before, 1 and 2 after, as partsOf(); down: the same along the other axis
PLD_FN SurfaceNear surfaceNear(float own, vec4 across, vec4 down) {
  vec2 ax = changeAlong(partsOf(own, across, true)), ay = changeAlong(partsOf(own, down, true));
  vec2 bx = changeAlong(partsOf(own, across, false)), by = changeAlong(partsOf(own, down, false));
  SurfaceNear surface;
  surface.inverse = ax.y + ay.y <= bx.y + by.y;
  vec2 x = surface.inverse ? ax : bx, y = surface.inverse ? ay : by;
  surface.change = vec2(x.x, y.x);
  surface.bend = vec2(x.y < 1.0f ? x.y : 0.0f, y.y < 1.0f ? y.y : 0.0f);
  return surface;
}

// Its depth at an offset in pixels. Planar metres, up to 3e38 beyond its horizon.
PLD_FN float surfaceAt(SurfaceNear surface, float own, vec2 offset) {
  precise float linear = 1.0f + surface.change.x * offset.x + surface.change.y * offset.y;
  precise float z = surface.inverse ? own / linear : own * linear;
  return linear > 0.0f ? min(z, 3e38f) : surface.inverse ? 3e38f : 0.0f;
}

// Relative difference in depth that is none there: what is rounded, what the corners' grid moves, and what bends away.
//   factor  pixels per texel
PLD_FN float surfaceContact(SurfaceNear surface, float factor, vec2 offset) {
  precise float grid = (abs(surface.change.x) + abs(surface.change.y)) * factor * PLD_UPSAMPLE_CORNERS;
  precise float away = surface.bend.x * offset.x * offset.x + surface.bend.y * offset.y * offset.y;
  precise float contact = PLD_UPSAMPLE_CONTACT + grid + away;
  return contact;
}

// Whether a texel holds one thin layer, and does not fill in depth as smoke does.
PLD_FN bool isThinTexel(LowTexel texel) {
  return abs(texel.z - texel.nearestZ) <= 1e-5f * texel.z;
}

// How much of a texel's layers stands before an opaque pixel that may lie nearer than the depth which the texel was
// tested against: one half from the nearest to their mean depth, the other from there as far again, or to that depth.
// What touches the pixel's surface stands before it. [0,1]
//   opaqueZ       of the pixel's surface, at the pixel or, where its plane is known, at the texel
//   texelOpaqueZ  as for upsampleShare()
//   contact       relative difference in depth that is none
PLD_FN float standingBefore(LowTexel texel, float opaqueZ, float texelOpaqueZ, float contact) {
  if (opaqueZ >= texelOpaqueZ) return 1.0f;
  float least = contact * texel.z;
  precise float front = max(texel.z - texel.nearestZ, least);
  precise float back = max(min(front, texelOpaqueZ - texel.z), least);
  precise float ahead = opaqueZ - texel.z + 2.0f * least;  // a whole `least` before it falls
  precise float behind = ahead / (ahead < 0.0f ? front : back);
  precise float before = 0.5f + 0.5f * behind;
  return clamp(before, 0.0f, 1.0f);
}

// How well a texel's depth fits a pixel's. (0,1]
//   opaqueZ, texelOpaqueZ  planar metres, > 0, +inf for sky: of the pixel; farthest of the texel's block
PLD_FN float depthFit(float opaqueZ, float texelOpaqueZ) {
  // 1 - nearer / farther: the scale of the scene does not matter, and two skies are at the same depth.
  float nearer = min(opaqueZ, texelOpaqueZ), farther = max(opaqueZ, texelOpaqueZ);
  if (!(farther > nearer)) return 1.0f + PLD_UPSAMPLE_LEAST;
  float differs = farther < 3e38f ? 1.0f - nearer / farther : 1.0f;
  precise float q = differs * (1.0f / PLD_UPSAMPLE_TOLERANCE);
  precise float fits = 1.0f / ((1.0f + q * q) * (1.0f + q * q)) + PLD_UPSAMPLE_LEAST;
  return fits;
}

// A tent of half width `reach`, texels.
PLD_FN float upsampleTent(vec2 offset, float reach) {
  vec2 tent = max(vec2(1.0f) - abs(offset) * (1.0f / reach), vec2(0.0f));
  precise float product = tent.x * tent.y;
  return product;
}

// Share of a texel in a pixel.
//   offset  from the pixel's sample to the texel's, texels
PLD_FN float upsampleShare(vec2 offset, float opaqueZ, float texelOpaqueZ) {
  precise float share = upsampleTent(offset, PLD_UPSAMPLE_TENT) * depthFit(opaqueZ, texelOpaqueZ);
  return share;
}

// How much the 7 x 7 tent counts: nothing where the near texels fit well enough. [0, PLD_UPSAMPLE_WIDE]
//   nearShares  sum of upsampleShare() over the texels
PLD_FN float wideWeight(float nearShares) {
  precise float weight = PLD_UPSAMPLE_WIDE * max(1.0f - nearShares * (1.0f / PLD_UPSAMPLE_ENOUGH), 0.0f);
  return weight;
}

//   weight  wideWeight()
PLD_FN float wideShare(vec2 offset, float opaqueZ, float texelOpaqueZ, float weight) {
  float reach = float(PLD_UPSAMPLE_REACH) + 1.0f;
  precise float share = weight * upsampleTent(offset, reach) * depthFit(opaqueZ, texelOpaqueZ);
  return share;
}

// Texels added up for one pixel.
struct LowSums {
  vec3 radiance, opacity;
  float share;        // of all texels
  float hidden;       // sum of share times mean opacity, and of it times the three that follow
  float shown;        // the same with light that only adds
  float weight, depthWeight, z;
  float nearestZ;
};

PLD_FN LowSums noTexels() {
  LowSums sums;
  sums.radiance = vec3(0.0f);
  sums.opacity = vec3(0.0f);
  sums.share = 0.0f;
  sums.hidden = 0.0f;
  sums.shown = 0.0f;
  sums.weight = 0.0f;
  sums.depthWeight = 0.0f;
  sums.z = 0.0f;
  sums.nearestZ = intBitsToFloat(0x7f800000);
  return sums;
}

//   share   of the texel, > 0
//   before  standingBefore()
PLD_FN LowSums addTexel(LowSums sums, LowTexel texel, float share, float before) {
  precise float part = share * before;
  precise float hidden = part * meanOf(texel.opacity);
  precise float shown = part * (meanOf(texel.opacity) + min(meanOf(texel.radiance), 1.0f));
  precise vec3 radiance = sums.radiance + part * texel.radiance;
  precise vec3 opacity = sums.opacity + part * texel.opacity;
  precise float weight = sums.weight + hidden * texel.weight;
  precise float depthWeight = sums.depthWeight + shown * texel.depthWeight;
  precise float z = sums.z + shown * texel.z;
  precise float hiddenSum = sums.hidden + hidden;
  precise float shownSum = sums.shown + shown;
  precise float shareSum = sums.share + share;
  LowSums result;
  result.radiance = radiance;
  result.opacity = opacity;
  result.share = shareSum;
  result.hidden = hiddenSum;
  result.shown = shownSum;
  result.weight = weight;
  result.depthWeight = depthWeight;
  result.z = z;
  result.nearestZ = shown > 0.0f ? min(sums.nearestZ, texel.nearestZ) : sums.nearestZ;
  return result;
}

// The texels as one layer of full resolution.
struct LowLayer {
  Layer layer;  // covers the pixel and transmits beta
  float weight, depthWeight;
  bool shows;
};

PLD_FN LowLayer lowLayerOf(LowSums sums) {
  LowLayer low;
  low.shows = sums.shown > 0.0f && sums.share > 0.0f;
  low.layer.coverage = 1.0f;
  low.layer.radiance = vec3(0.0f);
  low.layer.transmission = vec3(1.0f);
  low.layer.z = 1.0f;
  low.weight = 0.0f;
  low.depthWeight = 0.0f;
  if (!low.shows) return low;
  precise vec3 radiance = sums.radiance / sums.share;
  precise vec3 transmission = max(vec3(1.0f) - sums.opacity / sums.share, vec3(0.0f));
  precise float z = sums.z / sums.shown;
  precise float depthWeight = sums.depthWeight / sums.shown;
  low.layer.radiance = radiance;
  low.layer.transmission = transmission;
  low.layer.z = z;
  low.weight = sums.hidden > 0.0f ? sums.weight / sums.hidden : depthWeight;
  low.depthWeight = depthWeight;
  return low;
}

PLD_FN OitSums lowLayerSums(LowLayer low, int normalisation) {
  return weighedSums(low.layer, low.weight, low.depthWeight, normalisation);
}
