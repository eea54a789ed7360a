// Motion and identity of the nearest fragment that hides everything; of several at one depth those of the smallest
// identity, then of the smallest motion.
#include "gl/exact_lists.glsl"
#include "gl/listed_marks.glsl"

layout(location = 0) out vec4 solidMarks;  // motion, 1, identity

uniform int rowLength;

bool comesBefore(vec4 a, vec4 b) {
  if (a.w != b.w) return a.w < b.w;
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

void main() {
  float nearest = intBitsToFloat(0x7f800000);
  vec4 marks = vec4(0.0f);
  for (uint next = pldLinks[headHere(uint(rowLength))]; next != 0u; next = pldLinks[linkOf(next - 1u)]) {
    float z = pldTransmissions[next - 1u].a;
    if (z > nearest || (z == nearest && !comesBefore(pldMarks[next - 1u], marks))) continue;
    nearest = z;
    marks = pldMarks[next - 1u];
  }
  solidMarks = vec4(marks.xy, 1.0f, marks.w);
}
