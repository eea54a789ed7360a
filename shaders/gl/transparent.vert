#include "gl/frame.glsl"
// Object to view space, and to the data window's clip space.
#include "gl/exact_coverage.glsl"
#include "gl/vertex_input.glsl"
uniform mat4 viewFromObject;
uniform mat3 normalFromObject;
#ifdef POINTS
uniform float pointScale;  // metres per unit of their radius
#endif

layout(location = 0) out vec3 viewPosition;
layout(location = 1) out vec3 viewNormal;
layout(location = 2) out vec4 textureUv;
layout(location = 3) out vec4 vertexColour;
#ifdef NORMAL_TEXTURE
layout(location = 7) out vec4 viewTangent;
#endif
invariant gl_Position;

//   at  corner of a particle's disc, in radii; and its radius
vec3 viewOf(vec3 pObject, vec4 at) {
  precise vec4 pView = viewFromObject * vec4(pObject, 1.0f);
#ifdef POINTS
  precise vec2 aside = at.xy * (at.z * pointScale);
  pView.xy += aside;
#endif
  return pView.xyz;
}

vec4 clipOf(vec3 pView) {
  precise vec4 clip = clipFromView * vec4(pView, 1.0f);
  return clip;
}

#ifdef EXACT_COVERAGE
layout(location = 5) flat out vec4 corners01;  // window pixels of the true corners
layout(location = 6) flat out vec2 corner2;

// Weights of this corner on the triangle, grown; also hands the true corners to the fragment stage.
vec3 grownCorner(int first, int corner) {
  vec3 own = vec3(corner == 0 ? 1.0f : 0.0f, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f);
  vec2 window[3];
  float w[3];
  bool resolved = true;
  for (int k = 0; k < 3; ++k) {
    vec4 clip = clipOf(viewOf(positionAt(first + k), uvAt(first + k)));
    w[k] = clip.w;
    precise vec2 ndc = clip.xy / clip.w;
    precise vec2 pixels = (vec2(ndc.x, -ndc.y) * 0.5f + 0.5f) * viewport;
    window[k] = pixels;
    resolved = resolved && clip.w > 0.0f && abs(pixels.x) < kLargestWindow && abs(pixels.y) < kLargestWindow;
  }
  corners01 = resolved ? vec4(window[0], window[1]) : vec4(kUncut);
  corner2 = window[2];
  if (!resolved) return own;

  float area = crossOf(window[1] - window[0], window[2] - window[0]);
  if (abs(area) < 1e-3f) return own;  // too small to extrapolate on
  float turn = area > 0.0f ? 1.0f : -1.0f;
  vec2 ahead = normalize(window[(corner + 1) % 3] - window[corner]);
  vec2 behind = normalize(window[corner] - window[(corner + 2) % 3]);
  vec2 outAhead = turn * vec2(ahead.y, -ahead.x), outBehind = turn * vec2(behind.y, -behind.x);
  vec2 mitre = (outAhead + outBehind) * (kGrow / max(1.0f + dot(outAhead, outBehind), 1e-4f));
  mitre *= min(1.0f, kLongestMitre / max(length(mitre), 1e-6f));
  vec2 grown = window[corner] + mitre;

  vec3 share = vec3(crossOf(window[1] - grown, window[2] - grown), crossOf(window[2] - grown, window[0] - grown),
                    crossOf(window[0] - grown, window[1] - grown)) / area;
  share /= vec3(w[0], w[1], w[2]);
  float sum = share.x + share.y + share.z;
  float nearest = 1.0f / max(max(w[0], w[1]), w[2]);
  if (!(sum > 0.25f * nearest)) return own;  // the plane turns away from the eye before it gets there
  return share / sum;
}
#endif

void main() {
#ifdef EXACT_COVERAGE
  int corner = gl_VertexID % 3;
  fetchVertex(gl_VertexID - corner, grownCorner(gl_VertexID - corner, corner));
#endif
  viewPosition = viewOf(position, uv);
  viewNormal = normalFromObject * normal;
  textureUv = uv;
  vertexColour = colour;
#ifdef NORMAL_TEXTURE
#ifndef EXACT_COVERAGE
  vec4 tangent = unpackTangent(packedTangent);
#endif
  viewTangent = vec4(mat3(viewFromObject) * tangent.xyz, tangent.w);
#endif
  gl_Position = clipOf(viewPosition);
}
