#pragma once
// Where a refracting layer shows the background from, as an offset in pixels. PT17 eqs. 8-10, MODEL section 5
#include "shared/accumulate.glsl"

const int PLD_REFRACT_OFF = 0;
const int PLD_REFRACT_FIXED = 1;      // the background lies a stated distance behind the surface
const int PLD_REFRACT_DEPTH = 2;      // it lies at the opaque depth
const int PLD_REFRACT_THICKNESS = 3;  // a parallel slab before the opaque depth: the ray is displaced, not turned

// How far behind the surface the background lies at most, which stands for the sky too: in depths of the surface, or
// where rays are parallel in pixels. No unit of length says what is far.
const float PLD_REFRACTION_REACH = 1e4f;
const float PLD_PARALLEL_REACH = 1e6f;
const float PLD_LARGEST_REACH = 1e30f;     // metres: nothing overflows
const float PLD_LEAST_FORWARD = 0.02f;     // a ray that goes more sideways is followed as if it went this much forward
const float PLD_LARGEST_OFFSET = 65536.0f; // pixels: beyond any picture, and 100,000 layers still add up
// A refracting layer that displaces nothing still takes part in the average, so it is no zero. Pixels
const float PLD_NO_OFFSET = 1e-20f;
// Part of its coverage that a refracting layer weighs even when it is perfectly clear.
const float PLD_CLEAR_SHARE = 0.05f;
// Depth of the opaque pixel over depth of the layer, below which the pixel stands in front of the layer.
const float PLD_IN_FRONT = 0.9999f;

struct RefractionSettings {
  int mode;          // PLD_REFRACT_*
  float distance;    // metres > 0, fixed mode only
  float focalX;      // NDC focal length times half the picture's width, pixels
  float focalY;      // the same of its height, pixels
  int orthographic;  // not 0: pixels per metre instead
};

// What scattering a layer does to what lies behind it.
struct Scatter {
  vec2 offset;     // refraction delta, float pixels, y down; exactly (0, 0) when the layer does not refract
  float variance;  // diffusion s^2, float pixels^2, >= 0
};

// One layer's part of the planes that scattering needs.
struct ScatterTargets {
  vec4 refraction;    // W delta.x, W delta.y, W, s^2
  float refractionZ;  // W z, kept in OitTargets::light.a
  float diffuseZ;     // planar z where the layer diffuses, else +inf; blended by MIN
};

// Direction of a ray from the eye after it enters, or (0, 0, 0) when all of it is reflected: k < 0.
//   toEye, normal  unit, dot(normal, toEye) >= 0
//   eta            index outside over index inside, > 0
PLD_FN vec3 refractedDirection(vec3 toEye, vec3 normal, float eta) {
  precise float cosEye = normal.x * toEye.x + normal.y * toEye.y + normal.z * toEye.z;
  precise float k = 1.0f - eta * eta * (1.0f - cosEye * cosEye);
  if (k < 0.0f) return vec3(0.0f);
  precise vec3 direction = (eta * cosEye - sqrt(k)) * normal - eta * toEye;
  return direction;
}

PLD_FN bool reflectsAll(vec3 toEye, vec3 normal, float eta) {
  precise float cosEye = normal.x * toEye.x + normal.y * toEye.y + normal.z * toEye.z;
  precise float k = 1.0f - eta * eta * (1.0f - cosEye * cosEye);
  return k < 0.0f;
}

// Pixels from the principal point, y down. pView looks down -z, z < 0.
PLD_FN vec2 fromPrincipalPoint(RefractionSettings settings, vec3 pView) {
  precise float scale = settings.orthographic != 0 ? 1.0f : 1.0f / max(-pView.z, 1e-7f);
  precise vec2 pixels = vec2(settings.focalX * (pView.x * scale), -settings.focalY * (pView.y * scale));
  return pixels;
}

// Metres.
//   z  planar, of the surface
PLD_FN float refractionReach(RefractionSettings settings, float z) {
  precise float reach = settings.orthographic != 0 ? PLD_PARALLEL_REACH / settings.focalX : PLD_REFRACTION_REACH * z;
  return min(reach, PLD_LARGEST_REACH);
}

// delta of one entering face, float pixels; (0, 0) when eta is 1, when all is reflected and in mode off.
//   pView        where the ray enters, view space, metres, z < 0
//   toEye        unit; from pView towards the eye
//   normal       unit, on the side of the eye
//   backgroundZ  planar metres, > 0, +inf for sky
//   thickness    metres along the normal (thickness mode only)
PLD_FN vec2 refractionOffset(RefractionSettings settings, vec3 pView, vec3 toEye, vec3 normal, float eta,
                             float backgroundZ, float thickness) {
  if (settings.mode == PLD_REFRACT_OFF || eta == 1.0f) return vec2(0.0f);
  if (reflectsAll(toEye, normal, eta)) return vec2(0.0f);
  vec3 inside = refractedDirection(toEye, normal, eta);
  precise float z = -pView.z;
  precise float behind = backgroundZ - z;
  float reach = refractionReach(settings, z);
  if (!(behind < reach)) behind = reach;
  behind = max(behind, 0.0f);
  precise vec3 reached = pView;
  if (settings.mode == PLD_REFRACT_THICKNESS) {
    precise float across = -(inside.x * normal.x + inside.y * normal.y + inside.z * normal.z);
    precise vec3 leaves = pView + inside * (thickness / max(across, PLD_LEAST_FORWARD));
    precise float left = max(behind + (leaves.z - pView.z), 0.0f);
    reached = leaves - toEye * (left / max(toEye.z, PLD_LEAST_FORWARD));
  } else {
    if (settings.mode == PLD_REFRACT_FIXED) behind = settings.distance;
    reached = pView + inside * (behind / max(-inside.z, PLD_LEAST_FORWARD));
  }
  vec2 there = fromPrincipalPoint(settings, reached);
  vec2 here = fromPrincipalPoint(settings, pView);
  precise vec2 offset = there - here;
  return clamp(offset, vec2(-PLD_LARGEST_OFFSET), vec2(PLD_LARGEST_OFFSET));
}

// An offset as records keep it: see PLD_NO_OFFSET.
PLD_FN vec2 recordedOffset(vec2 offset) {
  vec2 kept = offset;
  if (kept.x == 0.0f && kept.y == 0.0f) kept.x = PLD_NO_OFFSET;
  return kept;
}

// How much a refracting layer weighs in the average of offsets. [0, 1 + PLD_CLEAR_SHARE]
PLD_FN float refractionWeight(float coverage, vec3 transmission) {
  if (transmission.r <= 0.0f && transmission.g <= 0.0f && transmission.b <= 0.0f) return 0.0f;
  precise float weight = meanOf(opacityOf(coverage, transmission)) + PLD_CLEAR_SHARE * coverage;
  return weight;
}

PLD_FN ScatterTargets packScatter(Layer layer, Scatter scatter) {
  bool refracts = scatter.offset.x != 0.0f || scatter.offset.y != 0.0f;
  float share = refracts ? refractionWeight(layer.coverage, layer.transmission) : 0.0f;
  precise vec2 offset = share * scatter.offset;
  precise float z = share * layer.z;
  ScatterTargets targets;
  targets.refraction = vec4(offset, share, scatter.variance);
  targets.refractionZ = z;
  targets.diffuseZ = scatter.variance > 0.0f ? layer.z : intBitsToFloat(0x7f800000);
  return targets;
}

// Indices outside over inside for red, green and blue of a dispersive material; green keeps `ior`. KHR_materials_dispersion
//   ior         inside over outside, >= 1
//   dispersion  20 over the Abbe number, >= 0
PLD_FN vec3 dispersedEta(float ior, float dispersion) {
  precise float spread = (ior - 1.0f) * (0.025f * dispersion);
  precise vec3 eta = vec3(1.0f) / max(vec3(ior - spread, ior, ior + spread), vec3(1.0f));
  return eta;
}

// What a dispersive layer adds to the plane of dispersion: weighted as its offset is, see packScatter().
//   dispersion  offset of red minus that of green, of blue minus that of green, float pixels
PLD_FN vec4 packDispersion(Layer layer, Scatter scatter, vec4 dispersion) {
  bool refracts = scatter.offset.x != 0.0f || scatter.offset.y != 0.0f;
  precise vec4 weighed = (refracts ? refractionWeight(layer.coverage, layer.transmission) : 0.0f) * dispersion;
  return weighed;
}

// The mean of it over a pixel's layers.
//   weightSum  sum of W
PLD_FN vec4 dispersionOf(vec4 dispersionSum, float weightSum) {
  precise vec4 mean = weightSum > 0.0f ? dispersionSum / weightSum : vec4(0.0f);
  return mean;
}

// What a pixel's sums say about the way back to the background.
struct Path {
  vec2 offset;        // mean delta, float pixels, y down
  bool refracts;
  float refractionZ;  // mean planar z of the refracting layers
  float variance;     // D^2, pixels^2
  float diffuseZ;     // nearest diffusing layer, +inf for none
};

PLD_FN Path pathOf(vec4 refraction, float refractionZ, float diffuseZ) {
  Path path;
  path.offset = vec2(0.0f);
  path.refracts = refraction.z > 0.0f;
  path.refractionZ = 0.0f;
  if (path.refracts) {
    precise vec2 mean = vec2(refraction.x, refraction.y) / refraction.z;
    precise float z = refractionZ / refraction.z;
    path.offset = mean;
    path.refractionZ = z;
  }
  path.variance = refraction.w;
  path.diffuseZ = diffuseZ;
  return path;
}

// Whether opaque depth `opaqueZ` stands in front of the layer at `layerZ`, so that it cannot be seen through it.
PLD_FN bool standsInFront(float opaqueZ, float layerZ) {
  precise float margin = PLD_IN_FRONT * layerZ;
  return opaqueZ < margin;
}

// Four pixels around a position, for explicit fetches: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
struct Footprint {
  ivec2 first;
  vec4 share;  // of each, in that order; they add up to 1
};

// position: pixels, +0.5 at a pixel's centre.
PLD_FN Footprint footprintAt(vec2 position) {
  precise vec2 corner = position - vec2(0.5f);
  vec2 whole = floor(corner);
  precise vec2 f = corner - whole;
  precise vec4 share = vec4((1.0f - f.x) * (1.0f - f.y), f.x * (1.0f - f.y), (1.0f - f.x) * f.y, f.x * f.y);
  Footprint footprint;
  footprint.first = ivec2(int(whole.x), int(whole.y));
  footprint.share = share;
  return footprint;
}
