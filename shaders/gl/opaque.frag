// One opaque fragment: what a G-buffer holds of it (OUTPUT_SURFACE), or what one light adds (OUTPUT_LIGHT). Fetch,
// shade through the shared model, write.
#include "gl/frame.glsl"
#include "gl/material.glsl"
#include "gl/lights.glsl"
#if defined(OUTPUT_SURFACE)
layout(location = 0) out vec4 normalZ;  // view space, unit; planar z
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 emission;
layout(location = 3) out vec4 indirect;
#else
layout(location = 0) out vec4 radiance;
#endif

const float kClipNear = 1e-7f;  // as in gbuffer/camera.h

void main() {
  Surface surface = surfaceHere();
  float z = -viewPosition.z;
  if (!(z > 0.0f)) discard;
  // Of orthographic cameras too, whose clip space has no depth.
  gl_FragDepth = kClipNear / z;
  vec3 toEye = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
  vec3 normal = normalHere(toEye);
#ifdef OUTPUT_SURFACE
  normalZ = vec4(normal, z);
  albedo = vec4(surface.baseColor, 1.0f);
  emission = vec4(surface.emission, 1.0f);
  indirect = vec4(0.0f);
#ifdef UNLIT
  emission.rgb = surface.baseColor;
#endif
#ifdef SURROUNDINGS
  float cosEye = clamp(dot(normal, toEye), PLD_GRAZING, 1.0f);
  indirect.rgb = reflectSurroundings(surface, cosEye) * surroundings.rgb;
#endif
#else
  radiance = vec4(0.0f);
#ifdef LIGHTS
  for (int i = 0; i < lightCount; ++i) {
    Arriving arriving = arrivingAt(lights[i], viewPosition);
    radiance.rgb += reflectTowardsEye(surface, normal, toEye, arriving.toLight) * arriving.irradiance;
  }
#endif
#endif
}
