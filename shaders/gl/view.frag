// One plane as a picture, to look at. PLD_VIEW_* of pellucid.h
#include "gl/resolve_here.glsl"

layout(location = 0) out vec4 picture;

uniform int view;

vec3 weightOf(vec3 denominator, vec3 opacity) {
  vec3 mean = vec3(meanColour(denominator.r, opacity.r), meanColour(denominator.g, opacity.g),
                   meanColour(denominator.b, opacity.b));
  return mean / (vec3(1.0f) + mean);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  VeilHere veil = veilAt(pixel);
  float count = float(min(veil.kind, 1));
  vec3 mean = vec3(0.0f), weight = vec3(0.0f), added = vec3(0.0f);
  vec2 clamped = vec2(0.0f);
#if defined(SORTED)
  vec4 light = texelHere(sortedLight, pixel);
  vec3 opacity = vec3(1.0f) - veil.resolved.transmission;
  count = light.a * 0.0625f;
  mean = vec3(meanColour(light.r, opacity.r), meanColour(light.g, opacity.g), meanColour(light.b, opacity.b));
  float largest = max(max(light.r, light.g), light.b);
#elif defined(PUBLISHED)
  PublishedSums sums = publishedAt(pixel);
  mean = sums.numerator / max(sums.denominator, PLD_LEAST_DENOMINATOR);
  float largest = max(max(sums.numerator.r, sums.numerator.g), max(sums.numerator.b, sums.denominator));
  float unit = PLD_SCATTER_UNIT;
  if (sums.variance >= unit * unit || abs(sums.offset.x) >= unit || abs(sums.offset.y) >= unit) clamped.y = 1.0f;
#else
  OitSums sums = sumsAt(pixel);
  count = sums.count * 0.0625f;
  mean = vec3(meanColour(sums.numerator.r, sums.denominator.r), meanColour(sums.numerator.g, sums.denominator.g),
              meanColour(sums.numerator.b, sums.denominator.b));
#ifdef AVERAGED_ONLY
  weight = sums.denominator / (vec3(1.0f) + sums.denominator);
#else
  weight = weightOf(sums.denominator, sums.opacity);
#endif
  added = sums.light;
  float largest = max(max(sums.numerator.r, sums.numerator.g), sums.numerator.b);
  largest = max(largest, max(max(sums.denominator.r, sums.denominator.g), sums.denominator.b));
#ifdef FRONT_TAIL
  count += frontAt(pixel).radiance.a * 0.0625f;
#ifdef LOW_OVER
  count += overAt(pixel).radiance.a * 0.0625f;
#endif
#endif
#endif
#ifdef HALF_SUMS
  if (largest >= 65504.0f) clamped.x = 1.0f;
#else
  if (largest >= 3e38f) clamped.x = 1.0f;
#endif
  picture = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  if (view == 1) picture.rgb = vec3(count);
  if (view == 2) picture.rgb = mean;
  if (view == 3) picture.rgb = veil.resolved.transmission;
  if (view == 4) picture.rgb = weight;
  if (view == 5) picture.rgb = added;
#ifdef SCATTER
  vec4 path = pathSumsAt(pixel);
  if (view == 6 && path.z > 0.0f)
    picture.rgb = vec3(0.5f + path.x / (128.0f * path.z), 0.5f + path.y / (128.0f * path.z), 1.0f);
  if (view == 7) picture.rgb = vec3(sqrt(path.w) * 0.015625f);
#endif
  if (view == 8) picture.rgb = vec3(clamped, 0.0f);
  if (view == 9 && solidAt(pixel).a < kNoDepth) picture.rgb = solidAt(pixel).rgb;
}
