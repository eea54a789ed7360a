#pragma once
// A vertex, from attributes; or pulled from storage, where each triangle must know its number: gl_PrimitiveID does not
// survive clipping on Mesa's software rasteriser.
uniform vec3 objectOrigin;  // object space, near the eye: PlacedNearEye
#ifdef NORMAL_TEXTURE
#include "shared/surface.glsl"
#endif
#ifdef EXACT_COVERAGE
// Mirrors Vertex in engine_bridge/scene/scene.h, 64 bytes.
struct PulledVertex {
  vec4 positionNormalX;
  vec4 normalYzUv0;
  vec4 uv1ColourRg;
  vec4 colourBaTangent;
};
layout(std430, binding = 5) readonly buffer Vertices { PulledVertex vertices[]; };
layout(std430, binding = 6) readonly buffer Indices { uint indices[]; };
layout(std430, binding = 2) readonly buffer TriangleNumbers { uint triangleNumbers[]; };  // within the primitive

layout(location = 4) flat out uint triangleNumber;
vec3 position, normal;  // the position less objectOrigin
vec4 uv, colour, tangent;

vec3 positionAt(int corner) { return vertices[indices[corner]].positionNormalX.xyz - objectOrigin; }

vec4 uvAt(int corner) {
  PulledVertex v = vertices[indices[corner]];
  return vec4(v.normalYzUv0.zw, v.uv1ColourRg.xy);
}

// The vertex that lies at weights `share` (sum 1) of the triangle whose first corner is `first`.
void fetchVertex(int first, vec3 share) {
  position = vec3(0.0f);
  normal = vec3(0.0f);
  uv = vec4(0.0f);
  colour = vec4(0.0f);
  tangent = vec4(0.0f);
  for (int k = 0; k < 3; ++k) {
    PulledVertex v = vertices[indices[first + k]];
    position += share[k] * (v.positionNormalX.xyz - objectOrigin);
    normal += share[k] * vec3(v.positionNormalX.w, v.normalYzUv0.xy);
    uv += share[k] * vec4(v.normalYzUv0.zw, v.uv1ColourRg.xy);
    colour += share[k] * vec4(v.uv1ColourRg.zw, v.colourBaTangent.xy);
#ifdef NORMAL_TEXTURE
    tangent += share[k] * unpackTangent(v.colourBaTangent.zw);
#endif
  }
  triangleNumber = triangleNumbers[first / 3];
}
#else
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uv;  // TEXCOORD_0, TEXCOORD_1
layout(location = 3) in vec4 colour;
layout(location = 4) in vec2 packedTangent;
#endif
