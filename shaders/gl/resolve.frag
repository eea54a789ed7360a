// Sums to what transparency does to a pixel: fetch, resolve through the shared model, write.
#include "gl/lookup.glsl"
#include "shared/resolve.glsl"

layout(binding = 1) uniform sampler2D radianceSum;
layout(binding = 2) uniform sampler2D weightSum;
layout(binding = 3) uniform sampler2D opacitySum;
layout(binding = 4) uniform sampler2D depthSum;
layout(binding = 7) uniform sampler2D lightSum;
layout(binding = 9) uniform sampler2D nearestZ;  // g: of the layers that diffuse
layout(binding = 10) uniform sampler2D dispersionSum;

layout(location = 0) out vec4 light;         // of the layers, premultiplied; 0 untouched, 1 shows its own background, 2 another
layout(location = 1) out vec4 transmission;  // of the background
layout(location = 2) out vec4 applied;       // transmission times another background; its mean times (1 - that alpha)

uniform int modulateSelf;
uniform ivec3 lookup;  // kernel, exact, levels of the pyramid
uniform float largestSpread;

vec3 throughOnly(vec3 passed, vec3 seen) {
  return vec3(passed.r > 0.0f ? seen.r : 0.0f, passed.g > 0.0f ? seen.g : 0.0f, passed.b > 0.0f ? seen.b : 0.0f);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  light = vec4(0.0f);
  transmission = vec4(1.0f, 1.0f, 1.0f, 0.0f);
  applied = vec4(0.0f);
  OitTargets targets;
  targets.radiance = texelFetch(radianceSum, pixel, 0);
  targets.weight = texelFetch(weightSum, pixel, 0);
  targets.opacity = texelFetch(opacitySum, pixel, 0);
  targets.depth = texelFetch(depthSum, pixel, 0);
  targets.light = texelFetch(lightSum, pixel, 0);
  OitSums sums = unpackSums(targets);
  vec4 front = texelFetch(solid, pixel, 0);
  bool hidesAll = front.a < kNoDepth;
#ifdef SCATTER
  vec4 path = texelFetch(refraction, pixel, 0);
  bool scatters = path.z > 0.0f || path.w > 0.0f;
  // A solid behind such layers is part of the background that they show.
  hidesAll = hidesAll && !scatters;
#endif
  if (sums.count == 0.0f && !hidesAll) return;
  Resolved resolved = resolveSums(sums, modulateSelf != 0);
  if (hidesAll) {
    resolved.transparent = overBackground(resolved, front.rgb);
    resolved.transmission = vec3(0.0f);
  }
  light = vec4(resolved.transparent, 1.0f);
  transmission = vec4(resolved.transmission, 0.0f);
#ifdef SCATTER
  if (!scatters) return;
  LookupChoice choice;
  choice.kernel = lookup.x;
  choice.exact = lookup.y;
  choice.levels = lookup.z;
  choice.largestSpread = largestSpread;
  vec4 dispersion = vec4(0.0f);
#ifdef DISPERSION
  dispersion = dispersionOf(texelFetch(dispersionSum, pixel, 0), path.z);
#endif
  vec4 seen = lookupAt(choice, pathOf(path, targets.light.a, texelFetch(nearestZ, pixel, 0).g), dispersion, pixel);
  precise vec3 shown = resolved.transmission * throughOnly(resolved.transmission, seen.rgb);
  precise float hole = meanOf(resolved.transmission) * (1.0f - seen.a);
  light.a = 2.0f;
  applied = vec4(shown, hole);
#endif
}
