#pragma once
// A glTF material at one point: its factors times its texels, to a Surface.
#include "shared/numeric.glsl"
#include "shared/surface.glsl"

// At an exact grazing angle a dielectric reflects everything; a silhouette is no reason to become solid.
const float PLD_GRAZING = 1e-4f;
// Sums of 100,000 layers at the largest weight stay finite.
const float PLD_BRIGHTEST = 1e20f;

// Factors times texels, as they come: surfaceOf() brings them into range.
struct MaterialPoint {
  vec4 base;  // colour, alpha
  vec3 emission;
  float metallic;
  float roughness;
  float transmission;
  float ior;
  vec4 specular;  // tint head-on, strength
};

// Beer-Lambert along `ratio` attenuation distances, one channel.
PLD_FN float attenuationOver(float colour, float ratio) {
  if (ratio <= 0.0f) return 1.0f;
  if (colour <= 0.0f) return 0.0f;
  return pldPow(colour, ratio);
}

PLD_FN vec3 attenuationOf(vec3 colour, float ratio) {
  vec3 attenuation;
  attenuation.r = attenuationOver(colour.r, ratio);
  attenuation.g = attenuationOver(colour.g, ratio);
  attenuation.b = attenuationOver(colour.b, ratio);
  return attenuation;
}

// A cut at or below 0 passes every alpha, 0 included: there is no rim.
PLD_FN float maskCoverage(float alpha, float cutoff, float width) {
  return cutoff <= 0.0f ? 1.0f : rimCoverage(alpha, cutoff, width);
}

//   coverage     of alpha, mask and overrides, [0,1]
//   attenuation  of the volume behind this face, [0,1]; 1 when thin
PLD_FN Surface surfaceOf(MaterialPoint point, float coverage, vec3 attenuation, bool unlit) {
  Surface surface;
  surface.coverage = coverage;
  surface.attenuation = attenuation;
  surface.transmission = clamp(point.transmission, 0.0f, 1.0f);
  surface.specular = point.specular;
  if (unlit) {
    surface.baseColor = max(vec3(point.base), vec3(0.0f));
    surface.emission = vec3(0.0f);
    surface.metallic = 0.0f;
    surface.roughness = 1.0f;
    surface.ior = 1.0f;
  } else {
    surface.baseColor = clamp(vec3(point.base), vec3(0.0f), vec3(1.0f));
    surface.emission = max(point.emission, vec3(0.0f));
    surface.metallic = clamp(point.metallic, 0.0f, 1.0f);
    surface.roughness = clamp(point.roughness, 0.0f, 1.0f);
    surface.ior = point.ior;
  }
  return surface;
}

// The side of a surface that the eye sees.
//   interpolated  vertex normal, any length
PLD_FN vec3 normalTowardsEye(vec3 interpolated, bool front, vec3 toEye) {
  vec3 outward = front ? interpolated : -interpolated;
  return dot(outward, outward) > 0.0f ? normalize(outward) : toEye;
}

// What a normal texture makes of a normal.
//   normal   unit, on the side that the file calls front
//   tangent  xyz towards rising u, any length, interpolated; w handedness; all 0 for none
//   texel    as stored, [0,1]
//   scale    of the texture, on its two slopes
PLD_FN vec3 bumpedNormal(vec3 normal, vec4 tangent, vec3 texel, float scale) {
  vec3 along = vec3(tangent) - normal * dot(normal, vec3(tangent));
  float squared = dot(along, along);
  if (!(squared > 0.0f)) return normal;
  along = along / sqrt(squared);
  vec3 across = cross(normal, along) * (tangent.w < 0.0f ? -1.0f : 1.0f);
  vec3 slope = texel * 2.0f - vec3(1.0f);
  vec3 bumped = along * (slope.x * scale) + across * (slope.y * scale) + normal * slope.z;
  float size = dot(bumped, bumped);
  return size > 0.0f ? bumped / sqrt(size) : normal;
}

// The same side as normalTowardsEye; a bump that turns away from the eye is turned back to the horizon.
PLD_FN vec3 bumpedTowardsEye(vec3 interpolated, vec4 tangent, vec3 texel, float scale, bool front, vec3 toEye) {
  vec3 outward = dot(interpolated, interpolated) > 0.0f ? normalize(interpolated) : (front ? toEye : -toEye);
  vec3 bumped = bumpedNormal(outward, tangent, texel, scale);
  vec3 seen = front ? bumped : -bumped;
  float facing = dot(seen, toEye);
  if (facing >= 0.0f) return seen;
  vec3 level = seen - facing * toEye;
  float size = dot(level, level);
  return size > 0.0f ? level / sqrt(size) : toEye;
}
