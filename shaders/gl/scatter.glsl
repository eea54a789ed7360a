#pragma once
// Refraction and diffusion of the layer under this fragment.
#include "gl/frame.glsl"
#include "gl/material.glsl"
#include "gl/scattered.glsl"
#include "shared/closed_body.glsl"
#include "shared/diffusion.glsl"
#ifdef SCATTER
#ifdef REFRACTS
uniform int bodyKind;       // PLD_BODY_*
uniform mat4 bodyFromView;  // of such a body

// Bodies say themselves how far light goes in them.
vec2 offsetOf(RefractionSettings settings, vec3 toEye, vec3 normal, float eta, float behind, float thickness) {
  if (bodyKind == PLD_BODY_NONE || settings.mode == PLD_REFRACT_FIXED || settings.mode == PLD_REFRACT_OFF)
    return refractionOffset(settings, viewPosition, toEye, normal, eta, behind, thickness);
  ClosedBody body;
  body.kind = bodyKind;
  body.fromView = bodyFromView;
  return bodyOffset(settings, body, viewPosition, toEye, normal, eta, behind);
}
#endif

// Depth of what stands behind all layers, planar metres.
float backdropZ(ivec2 pixel) {
  float z = texelFetch(opaqueZ, pixel, 0).r;
#ifdef SOLIDS
  z = min(z, texelFetch(solid, pixel, 0).a);
#endif
  return z;
}

Scattered scatterHere(Layer layer, Surface surface, ivec2 pixel) {
  Scattered here = scattersNothing();
#ifdef REFRACTS
  // Entering faces only: along the ray that has not been bent, back faces would reflect all.
  if (gl_FrontFacing && material.scattering.z != 1.0f) {
    vec3 toEye = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
    vec3 normal = normalHere(toEye);
    RefractionSettings settings;
    settings.mode = int(refraction.x);
    settings.distance = refraction.y;
    settings.focalX = refraction.z;
    settings.focalY = refraction.w;
    settings.orthographic = orthographic;
    float thickness = material.scattering.w * thicknessScale;
#ifdef REFRACTION_TEXTURE
    thickness *= thicknessTexel();
#endif
    float behind = backdropZ(pixel);
    vec2 offset = offsetOf(settings, toEye, normal, material.scattering.z, behind, thickness);
    here.scatter.offset = recordedOffset(offset);
#ifdef DISPERSES
    vec2 red = offsetOf(settings, toEye, normal, material.dispersion.r, behind, thickness);
    vec2 blue = offsetOf(settings, toEye, normal, material.dispersion.g, behind, thickness);
    here.dispersion = vec4(red - offset, blue - offset);
#endif
  }
#endif
#ifdef DIFFUSES
  DiffusionSettings settings;
  settings.k0 = diffusion.x;
  settings.k1 = diffusion.y;
  settings.netCoverage = int(diffusion.z);
  settings.focalPixels = refraction.z;
  settings.orthographic = orthographic;
  float collimation = material.scattering.x >= 0.0f
                          ? material.scattering.x
                          : collimationOf(surface.roughness * material.covering.a, material.scattering.y);
  here.scatter.variance = layerVariance(settings, layer.coverage, layer.transmission, collimation, layer.z,
                                        backdropZ(pixel));
#endif
  return here;
}
#endif
