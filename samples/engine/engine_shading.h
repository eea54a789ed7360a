// How a small engine shades: GLSL 450 behind the #version line, for OpenGL and for Vulkan.
//   kMeshVertex  with kGBuffer or, behind Pellucid's seam, kGlass
//   kFullScreen  with kOcclusion or kLight
//   kMeshVertex  with kCaster, behind Pellucid's text of casters: what the sun sees
// Uniform blocks are those of engine_scene.h. Pellucid's part has the lower bindings. Where transparent things cast
// shadows, SUN_IS_SHADOWED is defined and Pellucid's text of lookups stands before kLight and kGlass.
#pragma once
#include <string>

namespace engine {

constexpr unsigned kShadowTableBinding = 11, kShadowMapsBinding = 12;  // of what Pellucid's lookups declare
constexpr unsigned kSceneBinding = 16, kMeshBinding = 17;              // the second but on Vulkan, where it is pushed
constexpr unsigned kTexturesBinding = 18, kDepthBinding = 19, kNormalBinding = 20, kAlbedoBinding = 21,
                   kOcclusionBinding = 22;

inline const std::string kNumbers = R"(
layout(std140, binding = 16) uniform SceneNumbers { mat4 clipFromView; vec3 toSun, sun, ambient; float rows; };
#ifdef VULKAN
layout(push_constant)
#else
layout(std140, binding = 17)
#endif
uniform MeshNumbers {
  mat4 viewFromObject;
  vec4 base;
  vec4 surfaceValues;  // roughness, transmission, ior, thickness in metres
  float cutoff;        // above 0 of leaves, which a mask cuts out
  int unlit, baseLayer, firstIndex;  // baseLayer of baseTextures, or less than 0
};
)";

inline const std::string kFullScreen = R"(
#ifndef VULKAN
#define gl_VertexIndex gl_VertexID
#endif
void main() { gl_Position = vec4(vec2((gl_VertexIndex & 1) << 2, (gl_VertexIndex & 2) << 1) - vec2(1.0), 0.5, 1.0); }
)";

inline const std::string kMeshVertex = kNumbers + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec2 uv;
layout(location = 0) out vec3 viewPosition;
layout(location = 1) out vec3 viewNormal;
layout(location = 2) out vec4 vertexColour;
layout(location = 3) out vec2 vertexUv;
void main() {
  viewPosition = vec3(viewFromObject * vec4(position, 1.0));
  viewNormal = transpose(inverse(mat3(viewFromObject))) * normal;
  vertexColour = colour;
  vertexUv = uv;
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";

// Colour, and in a what part of the pixel is covered: of leaves by how far the mask's edge is, in pixels.
inline const std::string kMaterial = kNumbers + R"(
layout(location = 0) in vec3 viewPosition;
layout(location = 1) in vec3 viewNormal;
layout(location = 2) in vec4 vertexColour;
layout(location = 3) in vec2 vertexUv;
layout(binding = 18) uniform sampler2DArray baseTextures;

vec4 baseHere() {
  vec4 here = base * vertexColour;
  if (baseLayer >= 0) here *= texture(baseTextures, vec3(vertexUv, float(baseLayer)));
  if (cutoff > 0.0) here.a = clamp((here.a - cutoff) / max(fwidthFine(here.a), 1e-4) + 0.5, 0.0, 1.0);
  return here;
}
)";

// Leaves are opaque where they cover all of a pixel; the rest of them is transparent.
inline const std::string kGBuffer = kMaterial + R"(
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
void main() {
  albedo = baseHere();
  if (cutoff > 0.0 && albedo.a < 1.0) discard;
  normal = vec4(normalize(gl_FrontFacing ? viewNormal : -viewNormal), 0.0);
}
)";

// A point of the G-buffer in view space.
inline const std::string kViewAt = R"(
layout(binding = 19) uniform sampler2D depth;
layout(binding = 20) uniform sampler2D normal;

vec3 viewAt(ivec2 pixel) {
  float z = clipFromView[3][2] / texelFetch(depth, pixel, 0).r;
  vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / vec2(textureSize(depth, 0)) - 1.0;
  return vec3(ndc * z / vec2(clipFromView[0][0], clipFromView[1][1]), -z);
}
)";

// Alchemy ambient obscurance (McGuire, Osman, Bukowski, Hennessy: HPG 2011) over pixels at fixed offsets, whose lengths
// in the scene grow with distance.
inline const std::string kOcclusion = kNumbers + kViewAt + R"(
layout(location = 0) out vec4 occlusion;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(depth, 0);
  occlusion = vec4(1.0);
  if (texelFetch(depth, pixel, 0).r <= 0.0) return;
  vec3 here = viewAt(pixel), n = texelFetch(normal, pixel, 0).xyz;
  float hidden = 0.0;
  for (int i = 0; i < 16; ++i) {
    float angle = 2.399963 * float(i), reach = 0.05 * float(size.y) * (float(i) + 0.5) / 16.0;
    ivec2 there = pixel + ivec2(round(reach * vec2(cos(angle), rows * sin(angle))));
    there = clamp(there, ivec2(0), size - 1);
    if (texelFetch(depth, there, 0).r <= 0.0) continue;
    vec3 to = viewAt(there) - here;
    hidden += max(dot(to, n) + 0.002 * here.z, 0.0) / (dot(to, to) + 1e-4 * here.z * here.z);
  }
  occlusion = vec4(max(1.0 + 0.03 * here.z * hidden / 16.0, 0.0));
}
)";

inline const std::string kLight = kNumbers + kViewAt + R"(
layout(binding = 21) uniform sampler2D albedo;
layout(binding = 22) uniform sampler2D occlusion;
layout(location = 0) out vec4 lit;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  lit = vec4(ambient, 1.0);
  if (texelFetch(depth, pixel, 0).r <= 0.0) return;
  vec3 fromSun = sun * max(dot(texelFetch(normal, pixel, 0).xyz, toSun), 0.0) / 3.14159265;
#ifdef SUN_IS_SHADOWED
  fromSun *= pldShadowOnOpaque(0, viewAt(pixel));
#endif
  lit.rgb = texelFetch(albedo, pixel, 0).rgb * (fromSun + ambient * texelFetch(occlusion, pixel, 0).r);
}
)";

inline const std::string kFresnel = R"(
float fresnel(float c, float ior) {
  if (ior <= 1.0) return 0.0;
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (ior * ior), 0.0));
  float p = (ior * c - inside) / (ior * c + inside), s = (c - ior * inside) / (c + ior * inside);
  return 0.5 * (p * p + s * s);
}
)";

// glTF: what a dielectric reflects and lets through; then one call. RIMS_OF_LEAVES is defined where rims are asked for.
inline const std::string kGlass = kMaterial + kFresnel + R"(
// Lambert + GGX, times the cosine.
vec3 reflectSun(vec3 n, vec3 toEye, vec3 albedo, float ior, float roughness) {
  float cosLight = dot(n, toSun);
  if (cosLight <= 0.0) return vec3(0.0);
  float cosEye = max(dot(n, toEye), 1e-4), a2 = pow(max(roughness, 0.03), 4.0);
  vec3 h = normalize(toSun + toEye);
  float cosHalf = clamp(dot(n, h), 0.0, 1.0), spread = cosHalf * cosHalf * (a2 - 1.0) + 1.0;
  float density = a2 / (3.14159265 * spread * spread);
  float visible = 0.5 / (cosLight * sqrt(cosEye * cosEye * (1.0 - a2) + a2) +
                         cosEye * sqrt(cosLight * cosLight * (1.0 - a2) + a2));
  return (albedo / 3.14159265 + vec3(fresnel(clamp(dot(toEye, h), 0.0, 1.0), ior) * density * visible)) * cosLight;
}

void main() {
  vec4 here = baseHere();
#ifdef RIMS_OF_LEAVES
  vec2 gradient = pldCoverageGradient(here.a);
#endif
  if (cutoff > 0.0 && here.a >= 1.0) discard;  // opaque
  vec3 toEye = normalize(-viewPosition);
  vec3 n = normalize(gl_FrontFacing ? viewNormal : -viewNormal);
  float cosEye = clamp(dot(n, toEye), 1e-4, 1.0), ior = surfaceValues.z;
  vec3 fromSun = sun;
#ifdef SUN_IS_SHADOWED
  fromSun *= pldShadow(0, viewPosition);
#endif
  vec3 reflected = here.rgb, transmission = vec3(0.0), around = vec3(0.0);
  if (cutoff > 0.0) {  // as the light pass
    around = here.a * here.rgb * ambient;
    reflected *= fromSun * max(dot(n, toSun), 0.0) / 3.14159265 + ambient;
  } else if (unlit == 0) {
    float f = fresnel(cosEye, ior);
    vec3 albedo = here.rgb * (1.0 - surfaceValues.y) * (1.0 - f);
    reflected = (albedo + vec3(f)) * ambient + reflectSun(n, toEye, albedo, ior, surfaceValues.x) * fromSun;
    transmission = here.rgb * surfaceValues.y * (1.0 - f);
  }
  PldSurface surface = pldSurface(here.a * reflected, here.a, transmission, viewPosition);
  surface.normal = n;
  if (surfaceValues.w > 0.0) surface.eta = 1.0 / ior;
  surface.thickness = surfaceValues.w;
  float met = surfaceValues.x * clamp(2.0 * ior - 2.0, 0.0, 1.0);  // of the roughness, by light that passes
  if (surfaceValues.y > 0.0) surface.collimation = 1.0 - met * met;
#ifdef RIMS_OF_LEAVES
  pldWriteRim(surface, around, gradient);  // of what is no leaf occlusion takes nothing
#else
  pldWriteFragment(surface);
#endif
}
)";

// In the sun's view space, which looks down -z.
inline const std::string kCaster = kMaterial + kFresnel + R"(
void main() {
  vec4 here = baseHere();
  vec3 n = normalize(viewNormal);
  PldCaster caster;
  caster.coverage = here.a;
  caster.transmission = vec3(0.0);
  if (unlit == 0) caster.transmission = here.rgb * surfaceValues.y * (1.0 - fresnel(abs(n.z), surfaceValues.z));
  caster.position = viewPosition;
  caster.normal = n;
  caster.eta = surfaceValues.w > 0.0 ? 1.0 / surfaceValues.z : 1.0;
  caster.identity = pldCasterIdentity(uint(firstIndex), uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)";

}  // namespace engine
