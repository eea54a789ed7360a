// Sums, and the picture behind them, to the picture: of an engine that keeps both on the device.
#include "gl/resolve_here.glsl"

layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 own = texelHere(background, pixel);
  VeilHere veil = veilAt(pixel);
  picture = own;
  if (veil.kind == 0) return;
  Resolved direct = veil.resolved;
  if (veil.kind == 2) direct.transmission = vec3(0.0f);
  picture = pictureOver(direct, own, veil.applied);
}
