// Layers of low resolution as a picture, before they are upsampled. PLD_VIEW_LOW_* of pellucid.h
layout(binding = 0) uniform sampler2D radianceTexels;  // of shaders/gl/low_texel.frag
layout(binding = 1) uniform sampler2D opacityTexels;
layout(binding = 2) uniform sampler2D depthTexels;

layout(location = 0) out vec4 picture;

uniform int view, factor;

float shownDepth(float z) { return z < 3e37f ? z / (z + 1.0f) : 1.0f; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) / factor;
  vec4 depths = texelFetch(depthTexels, at, 0);
  picture = vec4(0.0f, 0.0f, 0.0f, 1.0f);
  if (view == 12) picture.rgb = texelFetch(radianceTexels, at, 0).rgb;
  if (view == 13) picture.rgb = vec3(1.0f) - texelFetch(opacityTexels, at, 0).rgb;
  if (view == 14 && depths.w != 0.0f)
    picture.rgb = vec3(shownDepth(depths.x), shownDepth(depths.y), shownDepth(depths.z));
}
