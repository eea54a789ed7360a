#pragma once
// A glTF material under this fragment: the only place that fetches its textures. Mirrors MaterialBlock in
// engine_bridge/scene/blocks.h.
#include "gl/frame.glsl"
#include "shared/material.glsl"
#include "shared/mask.glsl"

layout(std140, binding = 1) uniform MaterialValues {
  vec4 baseColor;
  vec4 emission;            // rgb radiance; a metallic
  vec4 interface_;          // roughness, transmission, ior, alpha cutoff
  vec4 volume;              // rgb attenuation colour; a thickness over attenuation distance, object space
  vec4 covering;            // r factor on coverage, g 1 for a material that only adds light, b scale of normals,
                            // a part of the roughness that light passing through meets
  vec4 specular;            // tint head-on, strength
  vec4 uvTransforms[16];    // per texture two rows (a, b, c) with uv' = row * (uv, 1); .w of the first: TEXCOORD set
  vec4 scattering;          // collimation, < 0: from roughness; diffuse transmission; eta; thickness, object space
  vec4 dispersion;          // eta of red, of blue
  vec4 particle;            // softness, metres; g of its phase function
} material;

layout(binding = 0) uniform sampler2D baseTexture;
layout(binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(binding = 2) uniform sampler2D emissiveTexture;
layout(binding = 3) uniform sampler2D transmissionTexture;
layout(binding = 4) uniform sampler2D thicknessTexture;
layout(binding = 8) uniform sampler2D specularTexture;
layout(binding = 9) uniform sampler2D specularColorTexture;
layout(binding = 10) uniform sampler2D normalTexture;

layout(location = 0) in vec3 viewPosition;
layout(location = 1) in vec3 viewNormal;
layout(location = 2) in vec4 textureUv;
layout(location = 3) in vec4 vertexColour;
#ifdef NORMAL_TEXTURE
layout(location = 7) in vec4 viewTangent;  // w handedness
vec3 normalTexel;                          // surfaceHere() fetches it
#endif

uniform float thicknessScale;  // metres per unit of object space

vec2 uvOf(int slot) {
  vec4 u = material.uvTransforms[2 * slot];
  vec4 v = material.uvTransforms[2 * slot + 1];
  vec3 uv1 = vec3(u.w == 0.0f ? textureUv.xy : textureUv.zw, 1.0f);
  return vec2(dot(u.xyz, uv1), dot(v.xyz, uv1));
}

float thicknessTexel() {
  return texture(thicknessTexture, uvOf(4)).g;
}

#ifdef MASK_UNLEVELLED
// Of the base texture, under this sample. Takes derivatives.
float texelsHere() {
  vec2 at = uvOf(0) * vec2(textureSize(baseTexture, 0));
  return texelsAcross(dFdx(at), dFdy(at), footprint);
}
#endif

#ifdef MASK_LEVELLED
uniform float maskResolved;  // coarsest level of the base texture that is cut (engine_bridge/scene/mask_levels.h)

struct PartlyCovered {
  float coverage;  // [0,1]
  vec3 colour;     // of the base texture
};

// The base texture at that level. The sampler's bias for the footprint counts for levels that are named, too.
vec4 baseTexelAt(vec2 uv, float level) {
  return textureLod(baseTexture, uv, level - log2(footprint));
}

// A sample beyond that level.
//   across  texelsAcross
//   beyond  how many levels
//   dx, dy  of texture coordinates, from pixel to pixel
//   factor  on the texture's alpha
PartlyCovered partlyCovered(float across, float beyond, vec2 dx, vec2 dy, float factor) {
  vec2 uv = uvOf(0);
  float cutoff = material.interface_.w, left = cutLeft(beyond);
  vec4 texel = baseTexelAt(uv, maskResolved);
  float alpha = factor * texel.a, rim = 0.0f;
#ifdef MASK_SMOOTH
  rim = footprint * left * (abs(factor * baseTexelAt(uv + dx, maskResolved).a - alpha) +
                            abs(factor * baseTexelAt(uv + dy, maskResolved).a - alpha));
  vec4 kept = factor >= cutoff ? baseTexelAt(uv, keptLevel(across, maskResolved, footprint)) : vec4(0.0f);
#else
  vec4 kept = texel;
  left = 1.0f;
#endif
  PartlyCovered sum;
  sum.coverage = partialCoverage(maskCoverage(alpha, cutoff, rim), kept.a, left);
  sum.colour = unweighted(kept + (texel - kept) * left).rgb;
  return sum;
}
#endif

// Takes derivatives: to be called before any discard.
//   rimWidth  of a mask, as a part of what alpha changes by over the sample
float coverageOf(float alpha, float rimWidth) {
#if defined(MASK_SMOOTH)
  float rim = footprint * fwidth(alpha) * rimWidth;
#ifdef MASK_UNLEVELLED
  rim *= rimLeft(texelsHere());
#endif
  float covered = maskCoverage(alpha, material.interface_.w, rim);
#elif defined(MASK_HARD)
  float covered = alpha >= material.interface_.w ? 1.0f : 0.0f;
#elif defined(BLEND)
  float covered = clamp(alpha, 0.0f, 1.0f);
#else
  float covered = 1.0f;
#endif
  return covered;
}

// Multiplies by the base texture. What the material covers of the sample, [0,1]. Takes derivatives.
float coveredByBase(inout vec4 base) {
  float rimWidth = 1.0f;
#ifdef MASK_LEVELLED
  vec4 factor = base;
  vec2 uv = uvOf(0), size = vec2(textureSize(baseTexture, 0)), dx = dFdx(uv), dy = dFdy(uv);
  float across = texelsAcross(dx * size, dy * size, footprint), under = texelsUnder(dx * size, dy * size, footprint);
  vec4 texel = texture(baseTexture, uv);
  // Aslant, the sampler would take a level that is not cut.
  if (levelsBeyond(across, maskResolved) > 0.0f) texel = baseTexelAt(uv, maskResolved);
  base *= unweighted(texel);
  rimWidth = rimLeft(across * exp2(-maskResolved));
#elif defined(BASE_TEXTURE)
#ifdef BASE_WEIGHTED
  base *= unweighted(texture(baseTexture, uvOf(0)));
#else
  base *= texture(baseTexture, uvOf(0));
#endif
#endif
  float covered = coverageOf(base.a, rimWidth);
#ifdef MASK_LEVELLED
  float beyond = levelsBeyond(under, maskResolved);
  if (beyond > 0.0f) {
    PartlyCovered here = partlyCovered(across, beyond, dx, dy, factor.a);
    base.rgb = factor.rgb * here.colour;
    covered = here.coverage;
  }
#endif
  return covered * material.covering.r;
}

// After surfaceHere(). Unit, on the side of the eye.
vec3 normalHere(vec3 toEye) {
#ifdef NORMAL_TEXTURE
  return bumpedTowardsEye(viewNormal, viewTangent, normalTexel, material.covering.b, gl_FrontFacing, toEye);
#else
  return normalTowardsEye(viewNormal, gl_FrontFacing, toEye);
#endif
}

bool isUnlit() {
#ifdef UNLIT
  return true;
#else
  return false;
#endif
}

// Takes derivatives: to be called before any discard.
Surface surfaceHere() {
  MaterialPoint point;
  point.specular = material.specular;
#ifdef NORMAL_TEXTURE
  normalTexel = texture(normalTexture, uvOf(5)).rgb;
#endif
  point.base = material.baseColor;
  point.emission = material.emission.rgb;
  point.metallic = material.emission.a;
  point.roughness = material.interface_.r;
  point.transmission = material.interface_.g;
  point.ior = material.interface_.b;
#ifdef SPECULAR_TEXTURE
  point.specular.a *= texture(specularTexture, uvOf(6)).a;
#endif
#ifdef SPECULAR_COLOUR_TEXTURE
  point.specular.rgb *= texture(specularColorTexture, uvOf(7)).rgb;
#endif
  vec3 attenuation = vec3(1.0f);
#ifdef VERTEX_COLOUR
  point.base *= vertexColour;
#endif
  float covered = coveredByBase(point.base);
#ifdef METALLIC_ROUGHNESS_TEXTURE
  vec4 metallicRoughness = texture(metallicRoughnessTexture, uvOf(1));
  point.roughness *= metallicRoughness.g;
  point.metallic *= metallicRoughness.b;
#endif
#ifdef EMISSIVE_TEXTURE
  point.emission *= texture(emissiveTexture, uvOf(2)).rgb;
#endif
#ifdef TRANSMISSION_TEXTURE
  point.transmission *= texture(transmissionTexture, uvOf(3)).r;
#endif
#ifdef VOLUME
  float ratio = material.volume.a * thicknessScale;
#ifdef THICKNESS_TEXTURE
  ratio *= thicknessTexel();
#endif
  // What enters on a front face leaves through a back face: counted once.
  if (gl_FrontFacing) attenuation = attenuationOf(material.volume.rgb, ratio);
#endif
  return surfaceOf(point, covered, attenuation, isUnlit());
}
