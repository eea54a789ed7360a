// Fog before what is opaque: one surface over the whole picture, marched in registers and written once.
#include "gl/frame.glsl"
#include "gl/lights.glsl"
#include "gl/sums_output.glsl"
#include "shared/medium.glsl"

// Mirrors FogBlock in engine_bridge/gl/fog_pass.cpp.
layout(std140, binding = 2) uniform FogValues {
  Medium medium;
  mat4 volumeFromView;
  vec4 pixelRay;      // offset, scale: see PixelRays
  ivec4 gridTexels;   // w: lights
  ivec4 volumeTexels;  // of one light; w: 1 where there is one
  ivec4 choices;      // PLD_FOG_*; 1 orthographic; 1 for net coverage
  vec4 spread;        // of what it diffuses: k0, k1 metres; F_px
};

layout(binding = 12) uniform sampler3D densityGrid;
layout(binding = 14) uniform sampler3D emissionGrid;  // of the same size, or one texel where it does not emit
#define gridSize gridTexels.xyz
#define hasVisibility (volumeTexels.w != 0)
#define lightsOfFog gridTexels.w

float densityTexel(ivec3 texel) {
  return texelFetch(densityGrid, clamp(texel, ivec3(0), gridTexels.xyz - 1), 0).r;
}

vec3 emissionTexel(ivec3 texel) {
  return texelFetch(emissionGrid, clamp(texel, ivec3(0), gridTexels.xyz - 1), 0).rgb;
}

#define LIGHT_VOLUME_TEXELS volumeTexels.xyz
#include "gl/light_volume.glsl"

PunctualLight lightNumber(int light) { return lights[light]; }

#include "shared/march.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifdef SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  WeightSettings settings;
  settings.kind = WEIGHT;
  settings.rangeNear = weightNear;
  settings.rangeFar = weightFar;
  settings.exponent = weightExponent;
  settings.reference = weightReference;
  precise vec2 at = pixelRay.xy + pixelRay.zw * vec2(pixel);
  FogSums fog = marchFog(medium, spanOfPixel(medium, at, choices.y, z), settings, choices.x);
  if (!fogShows(fog)) discard;
  writeOitSums(fogOitSums(fog, choices.x), fogZ(fog));
#ifdef SCATTER
  writeNoScatter();
  DiffusionSettings spreads;
  spreads.k0 = spread.x;
  spreads.k1 = spread.y;
  spreads.netCoverage = choices.z;
  spreads.focalPixels = spread.z;
  spreads.orthographic = choices.y;
  FogSpread spreadHere = fogSpread(medium, fog, spreads, z);
  if (spreadHere.variance > 0.0f) {
    refractionSum.a = spreadHere.variance;
    writeDiffuseZ(spreadHere.z);
  }
#endif
}
