// Composites one pixel's list in the order of depth over the nearest solid, in double precision and by the rules of
// composite/over.cpp. The result has the same bits for every order of the list. MODEL section 1
#include "gl/exact_lists.glsl"

PLANE_OUTPUTS

uniform int rowLength;
#ifdef SOLIDS
layout(binding = 6) uniform sampler2D solidHere;  // rgb, planar z
#endif

#define kNowhere intBitsToFloat(0x7f800000)  // Vulkan takes no call for a constant

#include "gl/exact_order.glsl"

// 2 atanh(s), |s| <= 1/3, to double precision.
double twoAtanh(double s) {
  precise double square = s * s, sum = 0.0lf;
  for (int k = 17; k >= 0; --k) sum = sum * square + 1.0lf / double(2 * k + 1);
  return 2.0lf * s * sum;
}

// -log(1 - opacity), 0 <= opacity < 1. GLSL has no logarithm of doubles.
double depthOfOpacity(double opacity) {
  if (opacity < 0.5lf) return twoAtanh(opacity / (2.0lf - opacity));
  precise double left = 1.0lf - opacity;
  double halvings = 0.0lf;
  while (left < 0.70710678lf) {
    left *= 2.0lf;
    halvings += 1.0lf;
  }
  return halvings * 0.69314718055994530942lf - twoAtanh((left - 1.0lf) / (left + 1.0lf));
}

// 1 - exp(-depth), depth >= 0.
double opacityOfDepth(double depth) {
  int doublings = 0;
  precise double part = -depth;
  while (part < -0.25lf) {
    part *= 0.5lf;
    ++doublings;
  }
  precise double lost = 0.0lf;  // exp(part) - 1
  for (int k = 14; k >= 1; --k) lost = part / double(k) * (1.0lf + lost);
  for (int i = 0; i < doublings; ++i) lost = lost * (lost + 2.0lf);
  return -lost;
}

struct Sheet {
  double light, opacity;  // of one channel
};

// OpenEXR's rule for samples in the same place: densities add, each keeps its share of the light.
Sheet mergedSheet(Sheet a, Sheet b) {
  Sheet merged;
  if (a.opacity >= 1.0lf || b.opacity >= 1.0lf) {
    merged.opacity = 1.0lf;
    merged.light = b.opacity < 1.0lf ? a.light : a.opacity < 1.0lf ? b.light : 0.5lf * (a.light + b.light);
    return merged;
  }
  double depth = depthOfOpacity(a.opacity), other = depthOfOpacity(b.opacity);
  precise double sum = depth + other;
  merged.opacity = opacityOfDepth(sum);
  double scale = a.opacity > 0.0lf ? depth / a.opacity : 1.0lf;
  double otherScale = b.opacity > 0.0lf ? other / b.opacity : 1.0lf;
  precise double light = (a.light * scale + b.light * otherScale) * (sum > 0.0lf ? merged.opacity / sum : 1.0lf);
  merged.light = light;
  return merged;
}

Sheet sheetOf(uint link, int channel) {
  Sheet sheet;
  sheet.light = double(pldRadiances[link - 1u][channel]);
  precise double opacity =
      double(pldRadiances[link - 1u].a) * (1.0lf - double(pldTransmissions[link - 1u][channel]));
  sheet.opacity = opacity;
  return sheet;
}

void main() {
  precise dvec3 light = dvec3(0.0lf), transmission = dvec3(1.0lf);
  float nearest = kNowhere, layers = 0.0f;
#ifdef SOLIDS
  vec4 solid = texelFetch(solidHere, ivec2(gl_FragCoord.xy), 0);
  if (solid.a < kNowhere) {
    light = dvec3(solid.rgb);
    transmission = dvec3(0.0lf);
    nearest = solid.a;
  }
#endif
  uint next = sortedList(pldLinks[headHere(uint(rowLength))]);
  while (next != 0u) {
    float z = depthOf(next);
    Sheet sheets[3];
    for (int c = 0; c < 3; ++c) sheets[c] = sheetOf(next, c);
    layers += 1.0f;
    for (next = after(next); next != 0u && depthOf(next) == z; next = after(next)) {
      for (int c = 0; c < 3; ++c) sheets[c] = mergedSheet(sheets[c], sheetOf(next, c));
      layers += 1.0f;
    }
    for (int c = 0; c < 3; ++c) {
      light[c] = sheets[c].light + (1.0lf - sheets[c].opacity) * light[c];
      transmission[c] = transmission[c] * (1.0lf - sheets[c].opacity);
    }
    nearest = min(nearest, z);
  }
#ifdef SOLIDS
  if (layers == 0.0f && solid.a < kNowhere) layers = 1.0f;
#endif
  sortedLight = vec4(vec3(light), layers);
  sortedTransmission = vec4(vec3(transmission), nearest);
}
