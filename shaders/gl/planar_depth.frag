// The host's depth to planar metres. Defines: DEPTH_IS_LINEAR, else CLIP_SCALE, CLIP_OFFSET and EMPTY of
// planarFromDevice().
#include "shared/device_depth.glsl"

layout(binding = 0) uniform sampler2D hostDepth;

layout(location = 0) out float planar;

uniform vec4 depthRows;  // a, b, c, d of DepthRows
uniform float metresPerUnit;

void main() {
  float depth = textureLod(hostDepth, gl_FragCoord.xy / vec2(textureSize(hostDepth, 0)), 0.0f).r;
  float nothing = intBitsToFloat(0x7f800000);
#ifdef DEPTH_IS_LINEAR
  float z = depth > 0.0f && depth < nothing ? depth : nothing;
#else
  DepthRows rows;
  rows.a = depthRows.x;
  rows.b = depthRows.y;
  rows.c = depthRows.z;
  rows.d = depthRows.w;
  float z = planarFromDevice(rows, depth, CLIP_SCALE, CLIP_OFFSET, EMPTY);
#endif
  precise float metres = z * metresPerUnit;
  planar = metres;
}
