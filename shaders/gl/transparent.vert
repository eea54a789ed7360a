#include "gl/frame.glsl"
// Object to view space, and to the data window's clip space.
#include "gl/vertex_input.glsl"
uniform mat4 viewFromObject;
uniform mat3 normalFromObject;

layout(location = 0) out vec3 viewPosition;
layout(location = 1) out vec3 viewNormal;
layout(location = 2) out vec4 textureUv;
layout(location = 3) out vec4 vertexColour;
invariant gl_Position;

void main() {
  fetchVertex();
  precise vec4 pView = viewFromObject * vec4(position, 1.0f);
  precise vec4 clip = clipFromView * vec4(pView.xyz, 1.0f);
  viewPosition = pView.xyz;
  viewNormal = normalFromObject * normal;
  textureUv = uv;
  vertexColour = colour;
  gl_Position = clip;
}
