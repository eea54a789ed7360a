// The nearest of a pixel's fragments that hide everything; of several at one depth each channel's largest, as offline.
#include "gl/exact_lists.glsl"

layout(location = 0) out vec4 solidRadiance;  // rgb, planar z

uniform int rowLength;

void main() {
  solidRadiance = vec4(vec3(0.0f), intBitsToFloat(0x7f800000));
  for (uint next = pldLinks[headHere(uint(rowLength))]; next != 0u; next = pldLinks[linkOf(next - 1u)]) {
    vec4 one = vec4(pldRadiances[next - 1u].rgb, pldTransmissions[next - 1u].a);
    if (one.a > solidRadiance.a) continue;
    if (one.a == solidRadiance.a) one.rgb = max(one.rgb, solidRadiance.rgb);
    solidRadiance = one;
  }
}
