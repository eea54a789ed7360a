#pragma once
// How a glTF surface reflects and transmits, towards one eye. Directions are unit, and say where they point to.
#include "shared/accumulate.glsl"

const float PLD_PI = 3.14159274f;
const float PLD_MIN_ROUGHNESS = 0.03f;  // below it a highlight of a point light falls between samples

struct Surface {
  vec3 baseColor;      // [0,1], linear
  float coverage;      // alpha: part of the pixel touched, [0,1]
  vec3 emission;       // scene-linear radiance, strength included
  float metallic;      // [0,1]
  vec3 attenuation;    // transmittance of the volume along the path inside, [0,1]; 1 when thin
  float roughness;     // perceptual, [0,1]
  float transmission;  // part of the light that enters and is not scattered back, [0,1]
  float ior;           // >= 1; 1 reflects nothing
  vec4 specular;       // of the dielectric: tint head-on, >= 0; strength, [0,1]. KHR_materials_specular; 1 for none
};

// A unit tangent and its handedness (1 or -1) in two numbers: folded onto an octahedron, the sign of y is the hand's.
PLD_FN vec2 packTangent(vec3 tangent, float handedness) {
  float size = abs(tangent.x) + abs(tangent.y) + abs(tangent.z);
  float x = tangent.x / size, y = tangent.y / size;
  vec2 folded = vec2(x, y);
  if (tangent.z < 0.0f) {
    folded.x = (1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    folded.y = (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
  }
  return vec2(folded.x, (folded.y + 2.0f) * handedness);
}

// xyz unit, w handedness; all 0 for what is no tangent.
PLD_FN vec4 unpackTangent(vec2 packed_) {
  if (packed_.y == 0.0f) return vec4(0.0f);
  float x = packed_.x, y = abs(packed_.y) - 2.0f;
  float z = 1.0f - abs(x) - abs(y);
  vec3 tangent = vec3(x, y, z);
  if (z < 0.0f) {
    tangent.x = (1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    tangent.y = (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
  }
  return vec4(normalize(tangent), packed_.y < 0.0f ? -1.0f : 1.0f);
}

// Reflectance of a smooth dielectric for unpolarised light. [0,1]
//   cosOutside  |cosine| between the normal and the direction outside the medium, [0,1]
//   ior         index inside over index outside, >= 1
PLD_FN float fresnelDielectric(float cosOutside, float ior) {
  if (ior <= 1.0f) return 0.0f;
  precise float c = clamp(cosOutside, 0.0f, 1.0f);
  precise float inside = sqrt(max(1.0f - (1.0f - c * c) / (ior * ior), 0.0f));
  precise float parallel = (ior * c - inside) / (ior * c + inside);
  precise float perpendicular = (c - ior * inside) / (c + ior * inside);
  precise float f = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return f;
}

// Schlick's conductor: base colour at normal incidence, white at grazing.
PLD_FN vec3 fresnelConductor(float cosine, vec3 baseColor) {
  precise float m = clamp(1.0f - cosine, 0.0f, 1.0f);
  precise float m5 = m * m * m * m * m;
  precise vec3 f = baseColor + (vec3(1.0f) - baseColor) * m5;
  return f;
}

// What the interface of a dielectric reflects, per channel, KHR_materials_specular. Its Fresnel term rises from F0 to 1
// as Schlick's does; here it rises as the exact one of the same index.
PLD_FN vec3 dielectricReflectance(Surface surface, float cosine) {
  float exact = fresnelDielectric(cosine, surface.ior);
  if (surface.specular == vec4(1.0f)) return vec3(exact);
  precise float root = (surface.ior - 1.0f) / (surface.ior + 1.0f);
  precise float headOn = root * root;
  precise float rise = headOn < 1.0f ? clamp((exact - headOn) / (1.0f - headOn), 0.0f, 1.0f) : 0.0f;
  precise vec3 tinted = min(headOn * vec3(surface.specular), vec3(1.0f));
  precise vec3 f = surface.specular.a * (tinted + (vec3(1.0f) - tinted) * rise);
  return f;
}

// Part of the light that does not enter a dielectric: one number, so that a tinted reflection tints nothing else.
PLD_FN float interfaceLoss(Surface surface, float cosine) {
  vec3 f = dielectricReflectance(surface, cosine);
  return max(f.r, max(f.g, f.b));
}

// Part of the light reflected specularly, per channel.
PLD_FN vec3 specularReflectance(Surface surface, float cosine) {
  vec3 dielectric = dielectricReflectance(surface, cosine);
  precise vec3 f = (1.0f - surface.metallic) * dielectric +
                   surface.metallic * fresnelConductor(cosine, surface.baseColor);
  return f;
}

// Lambertian albedo left after metal, transmission and what the interface reflects.
PLD_FN vec3 diffuseAlbedo(Surface surface, float cosEye) {
  float f = interfaceLoss(surface, cosEye);
  precise vec3 albedo = surface.baseColor * ((1.0f - surface.metallic) * (1.0f - surface.transmission) * (1.0f - f));
  return albedo;
}

// t at the actual angle. DESIGN, Materials
PLD_FN vec3 transmissionAt(Surface surface, float cosEye) {
  float f = interfaceLoss(surface, cosEye);
  precise vec3 t = surface.baseColor * surface.attenuation * (surface.transmission * (1.0f - surface.metallic) * (1.0f - f));
  return clamp(t, vec3(0.0f), vec3(1.0f));
}

// Square of the sine between two unit vectors, 1 beyond a right angle. Near 0 a cosine in floats keeps too little of it
// for a narrow highlight.
PLD_FN float sineSquaredBetween(vec3 a, vec3 b) {
  precise float cosine = dot(a, b);
  if (cosine <= 0.0f) return 1.0f;
  precise vec3 across = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  precise float squared = dot(across, across);
  return min(squared, 1.0f);
}

// Microfacets whose normal lies at this sine from the surface's, GGX. 1/sr
//   a2  roughness to the power of 4
PLD_FN float ggxDensity(float sineSquared, float a2) {
  precise float spread = sineSquared * (1.0f - a2) + a2;
  precise float d = a2 / (PLD_PI * spread * spread);
  return d;
}

// Lambert + GGX (height-correlated Smith), times the cosine to the light. 1/sr
PLD_FN vec3 reflectTowardsEye(Surface surface, vec3 normal, vec3 toEye, vec3 toLight) {
  float cosLight = dot(normal, toLight);
  if (cosLight <= 0.0f) return vec3(0.0f);
  float cosEye = max(dot(normal, toEye), 1e-4f);
  vec3 toHalf = normalize(toLight + toEye);
  float roughness = max(surface.roughness, PLD_MIN_ROUGHNESS);
  precise float a = roughness * roughness;
  precise float a2 = a * a;
  float d = ggxDensity(sineSquaredBetween(normal, toHalf), a2);
  precise float maskEye = cosLight * sqrt(cosEye * cosEye * (1.0f - a2) + a2);
  precise float maskLight = cosEye * sqrt(cosLight * cosLight * (1.0f - a2) + a2);
  precise float visible = 0.5f / (maskEye + maskLight);
  vec3 f = specularReflectance(surface, clamp(dot(toEye, toHalf), 0.0f, 1.0f));
  precise vec3 reflected = (diffuseAlbedo(surface, cosEye) * (1.0f / PLD_PI) + f * (d * visible)) * cosLight;
  return reflected;
}

// Part of a constant surrounding radiance sent to the eye. Exact for smooth surfaces; a rough interface is taken at the
// mirror angle.
PLD_FN vec3 reflectSurroundings(Surface surface, float cosEye) {
  precise vec3 reflected = diffuseAlbedo(surface, cosEye) + specularReflectance(surface, cosEye);
  return reflected;
}

// The layer that a shaded surface adds.
//   reflected  L_r without emission: light sent to the eye as if coverage were 1
//   additive   a material that only adds light
PLD_FN Layer layerOf(Surface surface, vec3 reflected, float cosEye, float z, bool additive) {
  precise vec3 radiance = surface.coverage * (reflected + surface.emission);
  Layer layer;
  layer.radiance = radiance;
  layer.coverage = additive ? 0.0f : surface.coverage;
  layer.transmission = transmissionAt(surface, cosEye);
  layer.z = z;
  return layer;
}

// Coverage at the rim of an alpha-tested surface: one pixel wide, centred on the cut. DESIGN, Materials
//   width  how much alpha changes over one pixel (fwidth); where it does not, there is no rim, and the cut is glTF's >=
PLD_FN float rimCoverage(float alpha, float cutoff, float width) {
  if (width < 1e-4f) return alpha >= cutoff ? 1.0f : 0.0f;
  precise float rim = (alpha - cutoff) / width + 0.5f;
  return clamp(rim, 0.0f, 1.0f);
}
