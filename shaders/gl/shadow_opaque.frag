// Depth of an opaque caster as its light sees it, the nearest by MIN.
#include "gl/frame.glsl"
#include "gl/exact_cut.glsl"
#include "gl/shadow_frame.glsl"
layout(location = 0) in vec3 viewPosition;
layout(location = 0) out float nearest;

void main() {
  if (outsideTriangle()) discard;
  if (!(-viewPosition.z > 0.0f)) discard;
  nearest = mapDepthOf(viewPosition);
}
