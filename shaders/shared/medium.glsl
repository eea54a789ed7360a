#pragma once
// Fog along one ray: how dense it is, how it is cut into steps, and how it enters a pixel's sums. PT17 section 7.2, MODEL
// section 11. Transmittance of even and layered fog is a closed form; light that it scatters is marched.
#include "shared/accumulate.glsl"
#include "shared/diffusion.glsl"
#include "shared/lights.glsl"
#include "shared/resolve.glsl"
#include "shared/surface.glsl"

const float PLD_NO_SURFACE = 3e38f;  // depth from which a ray ends on nothing

// A medium, in the view space of one camera.
struct Medium {
  vec4 scattering;    // rgb albedo of one scattering event, [0,1]; a: g of Henyey and Greenstein, (-1,1), > 0 forward
  vec4 extinction;    // x: 1/m at the base; y: 1/m by which its logarithm falls with height; z: 1 where a box bounds it;
                      // w: 1 where a grid multiplies it
  vec4 march;         // x: metres beyond which there is none; y: steps; z: 1 - collimation, how much it diffuses;
                      // w: 1 where x is for rays that end on nothing alone
  vec4 up;            // unit, of the world; w: height of view space's origin over the base, metres
  vec4 ambient;       // rgb mean radiance of the surroundings
  vec4 ambientRed;    // xyz first order of it about a direction, per channel: radiance is ambient + dot(this, direction)
  vec4 ambientGreen;
  vec4 ambientBlue;
  vec4 glow;          // rgb radiance that it emits per opacity: what a metre adds over the extinction; a: 1 where a
                      // grid emits, too
  mat4 boxFromView;   // the box becomes [0,1]^3
};

// The part of a ray that lies in the medium and before what ends it.
struct FogSpan {
  vec3 origin;      // view space, metres
  vec3 direction;   // unit, away from the eye
  float start;      // metres from the origin
  float end;        // >= start
  float zPerMetre;  // planar depth gained by a metre, > 0
  float depth;      // optical depth of the whole, >= 0; of grids 0: they are marched
};

// One step of the march: even within.
struct FogStep {
  float begin;  // metres from the origin
  float end;
  float depth;  // optical depth, >= 0
  float z;      // planar metres of its middle
  vec3 middle;  // view space
};

// Part of light that turns by an angle, per steradian: integrates to 1 over the sphere. Henyey and Greenstein 1941
//   cosTurn  cosine between the ways in which light travels before and after: 1 is straight on
PLD_FN float henyeyGreenstein(float cosTurn, float g) {
  float size = abs(g), towards = g < 0.0f ? -cosTurn : cosTurn;
  precise float d = max((1.0f - size) * (1.0f - size) + 2.0f * size * (1.0f - towards), 1e-6f);
  precise float phase = (1.0f - g * g) / (4.0f * PLD_PI * d * sqrt(d));
  return phase;
}

// (1 - exp(-x)) / x for x >= 0.
PLD_FN float fadingMean(float x) {
  if (x < 1e-20f) return 1.0f;
  precise float mean = pldOneMinusExp(x) / x;
  return mean;
}

PLD_FN float heightOf(Medium medium, vec3 point) {
  precise float height = dot(vec3(medium.up), point) + medium.up.w;
  return height;
}

// 1/m, of even and layered media. Grows below the base, up to exp(60) times.
PLD_FN float extinctionAt(Medium medium, float height) {
  precise float exponent = clamp(-height * medium.extinction.y, -87.0f, 60.0f);
  precise float extinction = medium.extinction.x * pldExp(exponent);
  return extinction;
}

// Optical depth between two distances on a ray; box and grid are not asked. Counted from the lower end, so that no large
// number meets a small one.
PLD_FN float depthBetween(Medium medium, vec3 origin, vec3 direction, float start, float end) {
  float first = heightOf(medium, origin + start * direction);
  float last = heightOf(medium, origin + end * direction);
  precise float rise = abs(last - first) * medium.extinction.y;
  precise float depth = extinctionAt(medium, min(first, last)) * (end - start) * fadingMean(rise);
  return min(depth, 1e6f);
}

// Distances at which a ray enters and leaves the box; the second is less than the first where it misses.
PLD_FN vec2 boxSpan(mat4 boxFromView, vec3 origin, vec3 direction) {
  vec4 from = boxFromView * vec4(origin, 1.0f);
  vec4 way = boxFromView * vec4(direction, 0.0f);
  vec2 span = vec2(0.0f, 1e30f);
  for (int axis = 0; axis < 3; ++axis) {
    float p = from[axis], v = way[axis];
    if (abs(v) < 1e-12f) {
      if (p < 0.0f || p > 1.0f) span = vec2(1.0f, 0.0f);
    } else {
      float a = -p / v, b = (1.0f - p) / v;
      span.x = max(span.x, min(a, b));
      span.y = min(span.y, max(a, b));
    }
  }
  return span;
}

// What even and layered fog leaves of a light on its way to a point, in the fog or beyond it. A sun over fog without a
// bound above arrives as stated.
//   toLight  unit
PLD_FN float lightPassed(Medium medium, PunctualLight light, vec3 toLight, vec3 point) {
  if (medium.extinction.w != 0.0f) return 1.0f;  // grids are marched
  bool endless = light.direction.w == 0.0f;
  float start = 0.0f;
  float end = endless ? 1e30f : length(vec3(light.position) - point);
  if (medium.extinction.z != 0.0f) {
    vec2 inside = boxSpan(medium.boxFromView, point, toLight);
    start = inside.x;
    end = min(end, inside.y);
    if (!(end > start)) return 1.0f;
  } else if (endless) {
    precise float slope = dot(vec3(medium.up), toLight) * medium.extinction.y;
    if (slope <= 1e-6f) return 1.0f;
    precise float depth = extinctionAt(medium, heightOf(medium, point)) / slope;
    return pldExp(-depth);
  }
  return pldExp(-depthBetween(medium, point, toLight, start, end));
}

//   z  planar depth of what ends the ray, +inf for nothing
PLD_FN FogSpan fogSpan(Medium medium, vec3 origin, vec3 direction, float zPerMetre, float z) {
  FogSpan span;
  span.origin = origin;
  span.direction = direction;
  span.zPerMetre = zPerMetre;
  span.start = 0.0f;
  span.end = medium.march.x;
  if (z < PLD_NO_SURFACE && (medium.march.w != 0.0f || z < medium.march.x * zPerMetre)) span.end = z / zPerMetre;
  if (medium.extinction.z != 0.0f) {
    vec2 inside = boxSpan(medium.boxFromView, origin, direction);
    span.start = max(span.start, inside.x);
    span.end = min(span.end, inside.y);
  }
  span.end = max(span.end, span.start);
  span.depth = 0.0f;
  if (medium.extinction.w == 0.0f) span.depth = depthBetween(medium, origin, direction, span.start, span.end);
  return span;
}

// Of a pixel.
//   at  direction at z = 1; of an orthographic camera, whose rays are parallel, the origin
PLD_FN FogSpan spanOfPixel(Medium medium, vec2 at, int orthographic, float z) {
  if (orthographic != 0) return fogSpan(medium, vec3(at, 0.0f), vec3(0.0f, 0.0f, -1.0f), 1.0f, z);
  precise float length_ = sqrt(1.0f + (at.x * at.x + at.y * at.y));
  precise vec3 direction = vec3(at, -1.0f) / length_;
  return fogSpan(medium, vec3(0.0f), direction, 1.0f / length_, z);
}

// -ln(1 - x) / x times y, for x <= 1.
PLD_FN float logarithmic(float x, float y) {
  if (abs(x) < 1e-3f) {
    precise float small = y * (1.0f + x * (0.5f + x * 0.333333333f));
    return small;
  }
  precise float large = y * (-pldLog(max(1.0f - x, 1e-30f)) / x);
  return large;
}

// How far from the start of a span an optical depth is reached.
PLD_FN float distanceOfDepth(Medium medium, FogSpan span, float depth) {
  float whole = span.end - span.start;
  if (!(span.depth > 0.0f)) return whole;
  precise float slope = dot(vec3(medium.up), span.direction) * medium.extinction.y;
  float nearHere = extinctionAt(medium, heightOf(medium, span.origin + span.start * span.direction));
  if (nearHere > 1e-20f) {
    precise float metres = logarithmic(min(depth * slope / nearHere, 1.0f), depth / nearHere);
    return clamp(metres, 0.0f, whole);
  }
  // The near end is beyond the medium: counted from the far one, which is denser.
  float away = extinctionAt(medium, heightOf(medium, span.origin + span.end * span.direction));
  precise float rest = max(span.depth - depth, 0.0f);
  precise float metres = whole - logarithmic(min(-rest * slope / away, 1.0f), rest / away);
  return clamp(metres, 0.0f, whole);
}

// Optical depth at which a share of the light that a span hides is hidden.
PLD_FN float depthOfShare(float depth, float share) {
  if (share >= 1.0f) return depth;
  float hides = pldOneMinusExp(depth);
  precise float hidden = share * hides;
  precise float passed = (1.0f - share) * hides + (1.0f - hides);
  return min(opticalDepth(hidden, passed), depth);
}

// Step `turn` of even and layered media: every one hides the same share, as the eye sees it.
PLD_FN FogStep evenStep(Medium medium, FogSpan span, int turn) {
  float count = medium.march.y;
  float before = depthOfShare(span.depth, float(turn) / count), after = depthOfShare(span.depth, float(turn + 1) / count);
  FogStep part;
  part.begin = turn == 0 ? span.start : span.start + distanceOfDepth(medium, span, before);
  part.end = float(turn + 1) >= count ? span.end : span.start + distanceOfDepth(medium, span, after);
  part.depth = max(after - before, 0.0f);
  precise float middle = 0.5f * (part.begin + part.end);
  part.middle = span.origin + middle * span.direction;
  part.z = max(middle * span.zPerMetre, 1e-6f);
  return part;
}

// Step `turn` of a grid: all have one length.
//   density  of the grid at the step's middle, a factor
PLD_FN FogStep gridStep(Medium medium, FogSpan span, int turn) {
  float count = medium.march.y;
  precise float length_ = (span.end - span.start) / count;
  FogStep part;
  part.begin = span.start + float(turn) * length_;
  part.end = float(turn + 1) >= count ? span.end : span.start + float(turn + 1) * length_;
  precise float middle = 0.5f * (part.begin + part.end);
  part.middle = span.origin + middle * span.direction;
  part.z = max(middle * span.zPerMetre, 1e-6f);
  part.depth = 0.0f;
  return part;
}

PLD_FN bool mediumEmits(Medium medium) {
  return medium.glow.r + medium.glow.g + medium.glow.b + medium.glow.a > 0.0f;
}

// Light that a step emits, as its near end sends it: integral of e exp(-t) over an even step, t the optical depth that
// is before.
//   perMetre  e of a grid at the step's middle: radiance that a metre adds
PLD_FN vec3 emittedByStep(Medium medium, FogStep part, vec3 perMetre) {
  precise vec3 sent = pldOneMinusExp(part.depth) * vec3(medium.glow) +
                      ((part.end - part.begin) * fadingMean(part.depth)) * perMetre;
  return sent;
}

// Light of the surroundings that is sent to the eye per event, before the albedo. Henyey and Greenstein's coefficients are
// the powers of g, so that of the first order is g itself.
PLD_FN vec3 ambientTowardsEye(Medium medium, vec3 direction) {
  vec3 slope;
  slope.r = dot(vec3(medium.ambientRed), direction);
  slope.g = dot(vec3(medium.ambientGreen), direction);
  slope.b = dot(vec3(medium.ambientBlue), direction);
  precise vec3 sent = vec3(medium.ambient) + medium.scattering.a * slope;
  return max(sent, vec3(0.0f));
}

const int PLD_FOG_ORDERED = 0;  // the fog's own light composited front to back: exact where nothing else is there
const int PLD_FOG_SUMS = 1;     // each step a layer of its own in the sums, as PT17 section 7.2 prints it

// What a ray has gathered so far.
struct FogSums {
  vec3 radiance;      // premultiplied, front to back
  float passed;       // of what stands behind the steps so far
  float depth;        // optical depth
  float weight;       // sum of w o, times what reaches the eye where ordered
  float depthWeight;  // the same of w_z
  float z;            // the same of z
  float share;        // the same of 1
  vec3 weighed;       // sum of w o S
  vec3 emitted;       // light of its own, front to back: apart from the radiance above, which it scatters
  float emittedWeight;  // sum of w_z times the mean of it
  float emittedZ;       // the same of z
  float seenZ;          // sum of z times what a step hides of the eye's light: in order, whatever the sums' order
};

PLD_FN FogSums noFog() {
  FogSums sums;
  sums.radiance = vec3(0.0f);
  sums.passed = 1.0f;
  sums.depth = 0.0f;
  sums.weight = 0.0f;
  sums.depthWeight = 0.0f;
  sums.z = 0.0f;
  sums.share = 0.0f;
  sums.weighed = vec3(0.0f);
  sums.emitted = vec3(0.0f);
  sums.emittedWeight = 0.0f;
  sums.emittedZ = 0.0f;
  sums.seenZ = 0.0f;
  return sums;
}

// Light that a step emits; before addStep() of the same.
PLD_FN FogSums addEmitted(FogSums sums, float z, vec3 sent, WeightSettings settings) {
  precise vec3 seen = sums.passed * sent;
  precise float mean = meanOf(seen);
  precise vec3 emitted = sums.emitted + seen;
  precise float weight = sums.emittedWeight + depthWeight(settings, z) * mean;
  precise float zSum = sums.emittedZ + z * mean;
  FogSums result = sums;
  result.emitted = emitted;
  result.emittedWeight = weight;
  result.emittedZ = zSum;
  return result;
}

// Whether a ray has met anything.
PLD_FN bool fogShows(FogSums fog) {
  return fog.share > 0.0f || meanOf(fog.emitted) > 0.0f;
}

//   source      light scattered towards the eye, per opacity: radiance
//   netOpacity  of the whole ray: what a weight that asks for opacity gets, so that no number of steps shows in it
PLD_FN FogSums addStep(FogSums sums, float depth, float z, vec3 source, WeightSettings settings, float netOpacity,
                       int order) {
  precise float hides = pldOneMinusExp(depth);
  precise float seen = sums.passed * hides;
  precise float share = order == PLD_FOG_ORDERED ? seen : hides;
  float w = layerWeight(settings, z, settings.kind == PLD_WEIGHT_EQ5 ? 0.0f : netOpacity), wz = depthWeight(settings, z);
  precise vec3 radiance = sums.radiance + seen * source;
  precise float passed = sums.passed * pldExp(-depth);
  precise float total = sums.depth + depth;
  precise float weight = sums.weight + w * share;
  precise float weightZ = sums.depthWeight + wz * share;
  precise float zSum = sums.z + z * share;
  precise float shareSum = sums.share + share;
  precise float seenZ = sums.seenZ + z * seen;
  precise vec3 weighed = sums.weighed + (w * share) * source;
  FogSums result = sums;
  result.radiance = radiance;
  result.passed = passed;
  result.depth = total;
  result.weight = weight;
  result.depthWeight = weightZ;
  result.z = zSum;
  result.share = shareSum;
  result.weighed = weighed;
  result.seenZ = seenZ;
  return result;
}

// What a ray emits, as the sums keep light that adds: `light` and its mean weight.
struct FogLightSums {
  vec3 light;
  float weight;
};

// Resolving takes from light what all occluders of its pixel may hide of it, the fog itself among them, which the march
// has taken already. So it is divided by that part: fog alone shows just what it emits. No light is more than doubled:
// where the fog hides more than half of what is behind it and its light is weighed as if it came from there, the light
// counts as nearer.
PLD_FN FogLightSums fogLightSums(FogSums fog, float depth, float hides) {
  FogLightSums sums;
  sums.light = fog.emitted;
  sums.weight = 0.0f;
  float mean = meanOf(fog.emitted);
  if (!(mean > 0.0f)) return sums;
  precise float own = fog.emittedWeight / mean;
  sums.weight = own;
  if (!(fog.share > 0.0f)) return sums;
  precise float occluders = fog.depthWeight / fog.share;
  if (!(occluders > 0.0f)) return sums;
  float beta = pldExp(-depth);
  precise float least = occluders * max(1.0f - 2.0f * beta, 0.0f);
  sums.weight = max(own, least);
  precise float ratio = min(sums.weight / occluders, 1e12f);
  precise vec3 light = fog.emitted / lightVisibility(beta, hides, ratio);
  sums.light = light;
  return sums;
}

// A ray's fog among the sums of its pixel: one layer. Ordered, its colour is that of the march and its weight the mean of
// its steps'; else the plain sums over the steps. What it emits is light that adds, under both orders as marched.
PLD_FN OitSums fogOitSums(FogSums fog, int order) {
  float depth = min(fog.depth, PLD_OPAQUE_DEPTH);
  float hides = pldOneMinusExp(depth);
  FogLightSums emitted = fogLightSums(fog, depth, hides);
  float share = fog.share > 0.0f ? fog.share : 1.0f;  // fog that only emits hides nothing
  OitSums sums;
  sums.light = emitted.light;
  precise float lightWeight = emitted.weight * meanOf(emitted.light);
  sums.lightWeight = lightWeight;
  sums.depth = vec3(depth);
  sums.count = 1.0f;
  precise float weight = fog.weight / share;
  precise float opacityWeight = hides * (fog.depthWeight / share);
  precise float opacityZ = hides * (fog.z / share);
  precise vec3 ordered = weight * fog.radiance;
  precise float hidden = weight * hides;
  sums.numerator = order == PLD_FOG_ORDERED ? ordered : fog.weighed;
  sums.denominator = vec3(order == PLD_FOG_ORDERED ? hidden : fog.weight);
  sums.opacity = vec3(order == PLD_FOG_ORDERED ? hides : fog.share);
  sums.opacityWeight = order == PLD_FOG_ORDERED ? opacityWeight : fog.depthWeight;
  sums.opacityZ = order == PLD_FOG_ORDERED ? opacityZ : fog.z;
  return sums;
}

// Mean planar depth of what is seen of it; of fog that only emits, of its light.
PLD_FN float fogZ(FogSums fog) {
  bool hides = fog.share > 0.0f;
  precise float z = (hides ? fog.z : fog.emittedZ) / (hides ? fog.share : meanOf(fog.emitted));
  return z;
}

// How far a ray's fog spreads what lies behind it, and from where: PT17 eq. 7 of the one layer that a ray's fog is,
// which covers what it hides and lies where what is seen of it lies in the mean. No cut between surfaces changes it.
struct FogSpread {
  float variance;  // s^2, float pixels^2
  float z;         // planar metres
};

//   behind  planar depth of what ends the ray, +inf for nothing
PLD_FN FogSpread fogSpread(Medium medium, FogSums fog, DiffusionSettings settings, float behind) {
  FogSpread spread;
  spread.variance = 0.0f;
  spread.z = intBitsToFloat(0x7f800000);
  float hides = pldOneMinusExp(min(fog.depth, PLD_OPAQUE_DEPTH));
  if (!(medium.march.z > 0.0f && settings.k0 > 0.0f && hides > 0.0f)) return spread;
  precise float z = fog.seenZ / hides;
  spread.z = max(z, 1e-6f);
  spread.variance = layerVariance(settings, hides, vec3(0.0f), 1.0f - medium.march.z, spread.z, behind);
  return spread;
}
