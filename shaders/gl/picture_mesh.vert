// A G-buffer's depth as a surface: two triangles between every four pixels that lie near each other.
#include "gl/frame.glsl"
#include "gl/shadow_frame.glsl"
layout(binding = 7) uniform sampler2D pictureZ;  // planar metres, +inf where nothing was hit

layout(location = 0) out vec3 viewPosition;

const float kApart = 1.1f;  // neighbours whose depths differ by a larger ratio do not belong to one surface

float zAt(ivec2 pixel) { return texelFetch(pictureZ, pixel, 0).r; }

vec3 eyePositionOf(ivec2 pixel) {
  vec2 at = vec2(pixel + picture.zw) + 0.5f;
  vec2 ndc = vec2(2.0f * at.x / float(picture.x) - 1.0f, 1.0f - 2.0f * at.y / float(picture.y));
  vec2 atOne = (ndc - lens.zw) / lens.xy;
  float z = zAt(pixel);
  return vec3(plane.z != 0 ? atOne : atOne * z, -z);
}

void main() {
  int quad = gl_VertexID / 6;
  ivec2 first = ivec2(quad % (plane.x - 1), quad / (plane.x - 1));
  float a = zAt(first), b = zAt(first + ivec2(1, 0)), c = zAt(first + ivec2(0, 1)), d = zAt(first + ivec2(1, 1));
  float least = min(min(a, b), min(c, d)), most = max(max(a, b), max(c, d));
  viewPosition = vec3(0.0f);
  gl_Position = vec4(2.0f, 2.0f, 2.0f, 1.0f);  // outside
  if (!(most <= least * kApart)) return;
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(0, 1), ivec2(1, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));
  vec4 pLight = lightFromEye * vec4(eyePositionOf(first + corners[gl_VertexID % 6]), 1.0f);
  viewPosition = pLight.xyz;
  gl_Position = clipFromView * vec4(pLight.xyz, 1.0f);
}
