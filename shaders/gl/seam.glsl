#pragma once
// What an engine's material shader holds: the outputs of a stage, and pldWriteFragment(), which it calls where it would
// write a colour. Defines choose the stage (STAGE_SOLIDS, STAGE_FRONT, STAGE_RIMS, else the layers) and the planes.
#include "gl/half.glsl"
#include "shared/diffusion.glsl"
#include "shared/resolve.glsl"  // here: what is first included inside of a condition is there under it alone
#if defined(STAGE_RIMS) || defined(RIMS_HERE)
#include "shared/occlusion.glsl"
#endif
#ifdef PLD_MARKS
vec4 seamMarks = vec4(0.0f);  // motion, unused, identity
#endif
#if defined(EXACT)
#include "gl/exact_output.glsl"
#elif defined(STAGE_SOLIDS) || defined(STAGE_FRONT)
PLANE_OUTPUTS  // solidRadiance: rgb, planar z; frontZ
#elif defined(STAGE_RIMS)
#include "gl/rims_output.glsl"
#elif defined(PUBLISHED)
#include "gl/published_output.glsl"
#else
#include "gl/sums_output.glsl"
#endif
#ifdef FRONT_TAIL
#include "gl/front_output.glsl"
#endif
#ifdef STAGE_RIMS
vec3 seamAround = vec3(0.0f);
vec2 seamGradient = vec2(0.0f);
bool seamIsRim = false;
#endif

// SCALE is a name that says which stage and permutation the text is for: with PLD_FLAG_VALIDATE pld_end() looks for it.
PLD_FRAME_LAYOUT uniform PldFrame {
  vec4 SCALE;          // metres per unit; pre-exposure; not 0: orthographic; PLD_OCCLUSION_*
  vec4 pldWeight;      // range near, far in metres; exponent; pixels of a row of the largest picture
  vec4 pldRefraction;  // PLD_REFRACT_*; metres (at a distance); focal length in x and y, pixels
  vec4 pldDiffusion;   // k0, k1 metres; width and height of the picture
  vec4 pldReference;   // of the weight, metres; unused
};
// What pld_fix() fixed is a constant; the rest is read from the block.
#ifndef UNITS
#define UNITS SCALE.x
#endif
#ifndef EXPOSURE
#define EXPOSURE SCALE.y
#endif
#ifndef ORTHOGRAPHIC
#define ORTHOGRAPHIC (SCALE.z != 0.0f ? 1 : 0)
#endif
#ifndef EXPONENT
#define RANGE_NEAR pldWeight.x
#define RANGE_FAR pldWeight.y
#define EXPONENT pldWeight.z
#define REFERENCE pldReference.x
#endif
#ifndef REFRACT
#define REFRACT int(pldRefraction.x)
#define REFRACT_DISTANCE pldRefraction.y
#endif
#ifndef FOCAL_X
#define FOCAL_X pldRefraction.z
#define FOCAL_Y pldRefraction.w
#endif
#ifndef DIFFUSION_K0
#define DIFFUSION_K0 pldDiffusion.x
#define DIFFUSION_K1 pldDiffusion.y
#endif
PLD_UNIT_0 uniform sampler2D pldOpaqueZ;  // planar metres, +inf where nothing is
PLD_UNIT_1 uniform sampler2D pldSolid;    // nearest fragment that hides everything: rgb, planar z
PLD_UNIT_2 uniform sampler2D pldFrontZ;   // nearest layer, planar metres
#ifdef RIMS_HERE
PLD_UNIT_3 uniform sampler2D pldOpaqueOpen;  // ambient occlusion of what is opaque, 1 open
#endif

// Under this fragment. A nearest lookup takes a rasteriser on a CPU less than a fetch, which asks for its level.
vec4 seamTexel(sampler2D plane) {
  return textureLod(plane, gl_FragCoord.xy / vec2(textureSize(plane, 0)), 0.0f);
}

// Looked up before main(): a CPU then waits for memory beside the host's shading and not after it. Not where a global
// may have no such value (LOOKED_UP_LATE).
#ifdef LOOKED_UP_LATE
#define seamOpaqueZ seamTexel(pldOpaqueZ).r
#define seamSolidZ seamTexel(pldSolid).a
#define seamFrontZ seamTexel(pldFrontZ).r
#else
#if defined(SCATTER) || defined(DEPTH_IN_SHADER)
float seamOpaqueZ = seamTexel(pldOpaqueZ).r;
#endif
#ifdef SOLIDS
float seamSolidZ = seamTexel(pldSolid).a;
#endif
#ifdef FRONT_TAIL
float seamFrontZ = seamTexel(pldFrontZ).r;
#endif
#ifdef PLD_MARKS
#if defined(NEAREST_HERE) && !defined(FRONT_TAIL)
float seamFrontZ = seamTexel(pldFrontZ).r;
#endif
#endif
#endif
#ifdef PLD_MARKS
#include "gl/seam_marks.glsl"
#endif

// One shaded transparent surface under this fragment.
struct PldSurface {
  vec3 radiance;       // premultiplied, scene-linear: coverage * reflected + emitted, >= 0
  float coverage;      // part of the pixel it touches, [0,1]; 0 for light that adds and hides nothing
  vec3 transmission;   // colour let straight through where it touches, at the actual angle, [0,1]
  vec3 position;       // view space, scene units, the eye looks down -z
  // With refraction or diffusion; pldSurface() fills in a surface that does neither.
  vec3 normal;         // view space, unit, on the side of the eye
  float eta;           // index outside over inside, green, > 0; 1 bends nothing
  vec2 etaRedBlue;     // of red and blue, with dispersion; a component that is not > 0 is as eta
  float thickness;     // scene units, along the normal, >= 0; PLD_REFRACT_THROUGH_SLAB alone reads it
  float collimation;   // [0,1]: 1 clear, 0 scatters all
#ifdef PLD_MARKS
  vec2 motion;    // pixels from where the point is seen to where it was seen in the last frame, y down, without jitter
  uint identity;  // of the object, at most 16777215; 0 for none
#endif
};

PldSurface pldSurface(vec3 radiance, float coverage, vec3 transmission, vec3 position) {
  PldSurface surface;
  surface.radiance = radiance;
  surface.coverage = coverage;
  surface.transmission = transmission;
  surface.position = position;
  surface.normal = vec3(0.0f, 0.0f, 1.0f);
  surface.eta = 1.0f;
  surface.etaRedBlue = vec2(0.0f);
  surface.thickness = 0.0f;
  surface.collimation = 1.0f;
#ifdef PLD_MARKS
  surface.motion = vec2(0.0f);
  surface.identity = 0u;
#endif
  return surface;
}

WeightSettings seamWeight() {
  WeightSettings settings;
  settings.kind = WEIGHT;
  settings.rangeNear = RANGE_NEAR;
  settings.rangeFar = RANGE_FAR;
  settings.exponent = EXPONENT;
  settings.reference = REFERENCE;
  return settings;
}

// Of offsets in pairs: which way y runs.
vec4 seamRows() { return vec4(1.0f, ROWS, 1.0f, ROWS); }

// The layer's numbers, brought into their ranges.
Layer seamLayer(vec3 radiance, float coverage, vec3 transmission, float z) {
  Layer layer;
  layer.radiance = clamp(radiance, vec3(0.0f), vec3(1e20f));
  layer.coverage = clamp(coverage, 0.0f, 1.0f);
  layer.transmission = clamp(transmission, vec3(0.0f), vec3(1.0f));
  layer.z = z;
  return layer;
}

#if !defined(STAGE_SOLIDS) && !defined(STAGE_FRONT) && !defined(STAGE_RIMS)
// Into the planes of the layers, or their lists.
void seamWrite(Layer layer, vec2 offset, float variance, vec4 dispersion) {
  Scatter scatter;
  scatter.offset = vec2(offset.x, offset.y * ROWS);
#ifdef DIFFUSES
  scatter.variance = variance;
#else
  scatter.variance = 0.0f;
#endif
#if defined(EXACT)
  appendLayer(layer, vec4(scatter.offset, scatter.variance, 0.0f), dispersion * seamRows(), uint(pldWeight.w));
#elif defined(PUBLISHED)
  writePublished(layer, scatter, seamWeight());
#else
#ifdef FRONT_TAIL
  writeFrontOrTail(layer, seamWeight(), isFront(layer.z, seamFrontZ));
#else
  writeSums(layer, seamWeight());
#endif
#ifdef SCATTER
  writeScatter(layer, scatter, dispersion * seamRows());
#endif
#ifdef HALF
  clampToHalf();
#endif
#endif
#ifdef PLD_MARKS
#ifdef MARKS_HERE
  writeMarks(layer);
#endif
#endif
}
#endif

// A layer in metres and pixels, for hosts that know its scattering already. What pldWriteFragment() ends in.
//   offset      float pixels of the stage, y down; (0, 0) does not refract
//   variance    s^2, pixels^2
//   dispersion  offset of red minus `offset`, of blue minus it
void pldWriteLayer(vec3 radiance, float coverage, vec3 transmission, float z, vec2 offset, float variance,
                   vec4 dispersion) {
  if (!(z > 0.0f)) discard;
#ifdef DEPTH_IN_SHADER
  if (z > seamOpaqueZ) discard;
#endif
  Layer layer = seamLayer(radiance, coverage, transmission, z);
#if defined(STAGE_SOLIDS)
  if (!isSolid(layer.coverage, layer.transmission)) discard;
#ifdef EXACT
  appendLayer(layer, vec4(0.0f), vec4(0.0f), uint(pldWeight.w));
#else
  solidRadiance = vec4(layer.radiance, z);
  gl_FragDepth = 1e-7f / z;
#ifdef PLD_MARKS
  solidMarks = vec4(seamMarks.xy, 1.0f, seamMarks.w);
#endif
#endif
#else
#ifdef SOLIDS
  if (isSolid(layer.coverage, layer.transmission) || z > seamSolidZ) discard;
#endif
#if defined(STAGE_FRONT)
  frontZ = z;
#elif defined(STAGE_RIMS)
  if (!seamIsRim || !isRim(layer.coverage)) discard;
#ifdef EXACT
  layer.radiance = max(seamAround, vec3(0.0f));
  appendLayer(layer, vec4(seamGradient, 0.0f, 0.0f), vec4(0.0f), uint(pldWeight.w));
#else
  writeRim(layer, max(seamAround, vec3(0.0f)), seamGradient, seamWeight());
#endif
#else
  seamWrite(layer, offset, variance, dispersion);
#endif
#endif
}

#ifdef SCATTER
// Depth of what stands behind all layers, planar metres.
float seamBackdropZ() {
#ifdef SOLIDS
  return min(seamOpaqueZ, seamSolidZ);
#else
  return seamOpaqueZ;
#endif
}

RefractionSettings seamRefraction() {
  RefractionSettings settings;
  settings.mode = REFRACT;
  settings.distance = REFRACT_DISTANCE;
  settings.focalX = FOCAL_X;
  settings.focalY = FOCAL_Y;
  settings.orthographic = ORTHOGRAPHIC;
  return settings;
}

vec2 seamOffset(PldSurface surface, float eta) {
  vec3 toEye = ORTHOGRAPHIC != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-surface.position);
  return refractionOffset(seamRefraction(), surface.position * UNITS, toEye, surface.normal, eta, seamBackdropZ(),
                          surface.thickness * UNITS);
}
#endif

void pldWriteFragment(PldSurface surface) {
  vec2 offset = vec2(0.0f);
  float variance = 0.0f;
  vec4 dispersion = vec4(0.0f);
  float z = -surface.position.z * UNITS;
#ifdef REFRACTS
  // Entering faces only: along the ray that has not been bent, back faces would reflect all.
  if (gl_FrontFacing && surface.eta != 1.0f && REFRACT != PLD_REFRACT_OFF) {
    vec2 green = seamOffset(surface, surface.eta);
    offset = recordedOffset(green);
#ifdef DISPERSION
    float etaRed = surface.etaRedBlue.x > 0.0f ? surface.etaRedBlue.x : surface.eta;
    float etaBlue = surface.etaRedBlue.y > 0.0f ? surface.etaRedBlue.y : surface.eta;
    if (etaRed != surface.eta || etaBlue != surface.eta)
      dispersion = vec4(seamOffset(surface, etaRed) - green, seamOffset(surface, etaBlue) - green);
#endif
  }
#endif
#ifdef DIFFUSES
  DiffusionSettings settings;
  settings.k0 = DIFFUSION_K0;
  settings.k1 = DIFFUSION_K1;
  settings.netCoverage = 0;
  settings.focalPixels = FOCAL_X;
  settings.orthographic = ORTHOGRAPHIC;
  vec3 transmission = clamp(surface.transmission, vec3(0.0f), vec3(1.0f));
  variance = layerVariance(settings, clamp(surface.coverage, 0.0f, 1.0f), transmission,
                           clamp(surface.collimation, 0.0f, 1.0f), z, seamBackdropZ());
#endif
#ifdef PLD_MARKS
  pldMark(surface.motion, surface.identity);
#endif
  pldWriteLayer(surface.radiance * EXPOSURE, surface.coverage, surface.transmission, z, offset, variance, dispersion);
}

#ifdef RIMS_HERE
ivec2 occludersSize() { return ivec2(pldDiffusion.zw); }

vec2 occluderAt(ivec2 pixel) {
  float z = texelFetch(pldOpaqueZ, pixel, 0).r;
#ifdef SOLIDS
  z = min(z, texelFetch(pldSolid, pixel, 0).a);
#endif
  return vec2(z, texelFetch(pldOpaqueOpen, pixel, 0).r);
}

#include "gl/neighbours.glsl"
#endif

#ifdef RIMS
// In place of pldWriteFragment(), for cut-out surfaces whose antialiased rim (0 < coverage < 1) takes its ambient
// occlusion from the opaque pixels beside it.
//   around    the part of surface.radiance that occlusion darkens, as radiance is
//   gradient  pldCoverageGradient(), taken before any discard
void pldWriteRim(PldSurface surface, vec3 around, vec2 gradient) {
#ifdef RIMS_HERE
  if (isRim(surface.coverage)) {
    float z = -surface.position.z * UNITS;
    precise float hidden = 1.0f - neighboursOcclusion(gradient, z, ivec2(gl_FragCoord.xy), int(SCALE.w));
    precise vec3 left = surface.radiance - hidden * around;
    surface.radiance = left;
  }
#endif
#ifdef STAGE_RIMS
  seamAround = around * EXPOSURE;
  seamGradient = gradient;
  seamIsRim = true;
#endif
  pldWriteFragment(surface);
}

// Change of coverage per pixel.
vec2 pldCoverageGradient(float coverage) {
#if __VERSION__ >= 450
  return vec2(dFdxFine(coverage), dFdyFine(coverage));
#else
  return vec2(dFdx(coverage), dFdy(coverage));
#endif
}
#endif
