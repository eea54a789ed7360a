#pragma once
// The light volume: the only place that fetches its texels. Includers define LIGHT_VOLUME_TEXELS, the texels of one
// light.
layout(binding = 13) uniform sampler3D lightVolume;  // lights above one another

vec3 visibilityTexel(int light, ivec3 texel) {
  ivec3 inside = clamp(texel, ivec3(0), LIGHT_VOLUME_TEXELS - 1);
  return texelFetch(lightVolume, inside + ivec3(0, 0, light * LIGHT_VOLUME_TEXELS.z), 0).rgb;
}
#include "shared/light_volume.glsl"
