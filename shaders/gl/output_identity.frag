// PLD_VIEW_IDENTITY of pellucid.h: of the nearest layer, else of what is solid behind none; 0 where neither is.
layout(binding = 13) uniform sampler2D layerMarks;  // of gl/seam_marks.glsl
#ifndef NO_SOLIDS
layout(binding = 6) uniform sampler2D solid;
layout(binding = 14) uniform sampler2D solidMarks;
#endif

layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float nowhere = intBitsToFloat(0x7f800000), identity = texelFetch(layerMarks, pixel, 0).IDENTITY;
#ifndef NO_SOLIDS
  if (identity == nowhere && texelFetch(solid, pixel, 0).a < nowhere) identity = texelFetch(solidMarks, pixel, 0).a;
#endif
  picture = vec4(identity == nowhere ? 0.0f : identity, 0.0f, 0.0f, 1.0f);
}
