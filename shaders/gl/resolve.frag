// Sums to what transparency does to a pixel, as records keep it.
#include "shared/published.glsl"
#include "gl/resolve_here.glsl"

// Of the layers, premultiplied; alpha: 0 untouched, 1 shows its own background, 2 another.
layout(location = 0) out vec4 light;
layout(location = 1) out vec4 transmission;  // of the background
layout(location = 2) out vec4 applied;       // transmission times another background; its mean times (1 - that alpha)

void main() {
  VeilHere veil = veilAt(ivec2(gl_FragCoord.xy));
  light = vec4(veil.resolved.transparent, float(veil.kind));
  transmission = vec4(veil.resolved.transmission, 0.0f);
  applied = veil.applied;
}
