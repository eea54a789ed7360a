// How a small engine shades, in GLSL without declarations of what it reads: each host puts its own before. They are
//   kMeshBody     in: position, normal; viewFromObject, clipFromView, normalFromObject; out: viewPosition, viewNormal
//   kGBufferBody  in: viewPosition, viewNormal; base; out: albedo, normal
//   kLightBody    textures albedo, normal, depth (reversed); toSun, sun, ambient; out: lit
//   kGlassBody    in: viewPosition, viewNormal; base; surfaceValues: roughness, transmission, ior, thickness in metres;
//                 kinds: unlit, volume; toSun, sun, ambient; the text of Pellucid's seam
#pragma once

namespace engine {

inline const char* const kMeshBody = R"(
void main() {
  viewPosition = vec3(viewFromObject * vec4(position, 1.0));
  viewNormal = normalFromObject * normal;
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";

inline const char* const kGBufferBody = R"(
void main() { albedo = base, normal = vec4(normalize(viewNormal), 0.0); }
)";

inline const char* const kLightBody = R"(
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 n = texelFetch(normal, pixel, 0).xyz;
  vec3 light = sun * max(dot(n, toSun), 0.0) / 3.14159265 + ambient;
  lit = texelFetch(depth, pixel, 0).r > 0.0 ? vec4(texelFetch(albedo, pixel, 0).rgb * light, 1.0) : vec4(ambient, 1.0);
}
)";

// glTF: what a dielectric reflects and lets through; then one call.
inline const char* const kGlassBody = R"(
float fresnel(float c, float ior) {
  if (ior <= 1.0) return 0.0;
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (ior * ior), 0.0));
  float p = (ior * c - inside) / (ior * c + inside), s = (c - ior * inside) / (c + ior * inside);
  return 0.5 * (p * p + s * s);
}

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
  vec3 toEye = normalize(-viewPosition);
  vec3 n = normalize(gl_FrontFacing ? viewNormal : -viewNormal);
  float cosEye = clamp(dot(n, toEye), 1e-4, 1.0), ior = surfaceValues.z;
  vec3 reflected = base.rgb, transmission = vec3(0.0);
  if (kinds.x == 0) {
    float f = fresnel(cosEye, ior);
    vec3 albedo = base.rgb * (1.0 - surfaceValues.y) * (1.0 - f);
    reflected = (albedo + vec3(f)) * ambient + reflectSun(n, toEye, albedo, ior, surfaceValues.x) * sun;
    transmission = base.rgb * surfaceValues.y * (1.0 - f);
  }
  PldSurface surface = pldSurface(base.a * reflected, base.a, transmission, viewPosition);
  surface.normal = n;
  if (kinds.y != 0) surface.eta = 1.0 / ior;
  surface.thickness = surfaceValues.w;
  float met = surfaceValues.x * clamp(2.0 * ior - 2.0, 0.0, 1.0);  // of the roughness, by light that passes
  if (surfaceValues.y > 0.0) surface.collimation = 1.0 - met * met;
  pldWriteFragment(surface);
}
)";

}  // namespace engine
