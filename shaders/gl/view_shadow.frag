// One face of a shadow map as a picture, texel by texel. PLD_VIEW_SHADOW_* of pellucid.h
// As shared/shadow_map.glsl has texels: hidden, part with a caster, its depth, that squared.
uniform sampler2DArray maps;

layout(location = 0) out vec4 picture;

uniform int view, face, channels, isLocal;

float shown(vec4 texel) {
  if (view == 15) return 1.0f - texel.x;
  if (view == 16) return texel.y;
  if (!(texel.y > 0.0f)) return 0.0f;
  float depth = texel.z / texel.y;
  return clamp(isLocal != 0 ? depth : 0.5f + 0.5f * depth, 0.0f, 1.0f);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 colour;
  for (int c = 0; c < 3; ++c) colour[c] = shown(texelFetch(maps, ivec3(at, face * channels + min(c, channels - 1)), 0));
  picture = vec4(colour, 1.0f);
}
