// PLD_VIEW_MOTION of pellucid.h: the mean of the layers' motion by their shares; a solid has the share 1.
#include "gl/resolve_here.glsl"

layout(binding = 13) uniform sampler2D layerMarks;  // of gl/seam_marks.glsl
#ifndef NO_SOLIDS
layout(binding = 14) uniform sampler2D solidMarks;
#endif

layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 marks = texelHere(layerMarks, pixel);
  precise vec3 sums = marks.rgb;
#ifndef NO_SOLIDS
  if (solidAt(pixel).a < kNoDepth) sums = sums + texelHere(solidMarks, pixel).rgb;
#endif
  VeilHere veil = veilAt(pixel);
  float hidden = veil.kind == 0 ? 0.0f : 1.0f - meanOf(veil.resolved.transmission);
  picture = vec4(sums.z > 0.0f ? sums.xy / sums.z : vec2(0.0f), 0.0f, hidden);
}
