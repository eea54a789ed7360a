// The host's depth, in its convention, to planar metres.
#include "shared/device_depth.glsl"

layout(binding = 0) uniform sampler2D hostDepth;

layout(location = 0) out float planar;

uniform vec4 depthRows;   // a, b, c, d of DepthRows
uniform vec4 depthReads;  // clip scale and offset; depth of nothing; metres per unit
uniform int depthIsLinear;

void main() {
  float depth = texelFetch(hostDepth, ivec2(gl_FragCoord.xy), 0).r;
  float nothing = intBitsToFloat(0x7f800000);
  float z = nothing;
  if (depthIsLinear != 0) {
    if (depth > 0.0f && depth < nothing) z = depth;
  } else {
    DepthRows rows;
    rows.a = depthRows.x;
    rows.b = depthRows.y;
    rows.c = depthRows.z;
    rows.d = depthRows.w;
    z = planarFromDevice(rows, depth, depthReads.x, depthReads.y, depthReads.z);
  }
  precise float metres = z * depthReads.w;
  planar = metres;
}
