#pragma once
// Particles: balls made of points, cards that face the camera. Lit as a medium is, by a phase function.
#include "gl/frame.glsl"
#include "gl/lights.glsl"
#include "gl/material.glsl"
#include "shared/medium.glsl"
#include "shared/particle.glsl"
#ifdef POINTS
uniform float pointScale;  // metres per unit of their radius
#endif
#ifdef LIGHT_VOLUME
#define LIGHT_VOLUME_TEXELS texelsOfParticles.xyz
#include "gl/light_volume.glsl"
#endif

// What particles fade before.
float depthBehind(ivec2 pixel) {
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifdef SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  return z;
}

#ifdef PARTICLE
// Light towards the eye per coverage: the albedo times what arrives, by the phase function.
vec3 scatteredByParticle(vec3 albedo, vec3 around, vec3 toEye) {
  vec3 sent = around;
#ifdef LIGHTS
#ifdef LIGHT_VOLUME
  vec3 texel = (volumeOfParticles * vec4(viewPosition, 1.0f)).xyz;
#endif
  for (int i = 0; i < lightCount; ++i) {
    Arriving arriving = arrivingAt(lights[i], viewPosition);
    vec3 lit = henyeyGreenstein(-dot(arriving.toLight, toEye), material.particle.y) * arriving.irradiance;
#ifdef LIGHT_VOLUME
    lit *= visibilityAt(i, texel);
#endif
    sent += lit;
  }
#endif
  return albedo * sent;
}
#endif
