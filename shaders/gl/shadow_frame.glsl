#pragma once
// What the stages of a shadow map know about it. Mirrors ShadowFrameBlock in engine_bridge/gl/shadow_draw.cpp.
layout(std140, binding = 2) uniform ShadowFrame {
  vec4 metric;          // depth = scale * (planar z or distance) + offset; z 1 for distance; w depth that a caster may
                        // lie behind the opaque
  uvec4 texels;         // x, y of the part's top left texel, wrapping; 1 for naive coins; seed of the map
  mat4 lightFromEye;    // view space of the G-buffer's camera to the light's
  vec4 lens;            // of that camera: NDC = xy * (x, y) / z + zw
  ivec4 picture;        // its display window's width and height; x, y of the data window in it
  ivec4 plane;          // the data window's width and height; 1 orthographic
};

float mapDepthOf(vec3 pLight) {
  return metric.x * (metric.z != 0.0f ? length(pLight) : -pLight.z) + metric.y;
}
