#include "gl/frame.glsl"
// Object to view space, and to the data window's clip space.
#include "gl/exact_coverage.glsl"
#include "gl/vertex_input.glsl"
uniform mat4 viewFromOffset;  // of points less objectOrigin
uniform mat3 normalFromObject;
#ifdef VERTEX_COLOUR
uniform vec4 instanceColour;  // multiplies the vertices' own
#endif
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

//   pOffset  object space, less objectOrigin
//   at       corner of a particle's disc, in radii; and its radius
vec3 viewOf(vec3 pOffset, vec4 at) {
  precise vec4 pView = viewFromOffset * vec4(pOffset, 1.0f);
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
layout(location = 5) flat out vec4 corner0;  // as gl/exact_cut.glsl reads them
layout(location = 6) flat out vec4 corner1;
layout(location = 8) flat out vec4 corner2;
layout(location = 9) flat out float winding;

// A triangle in the window, before it is grown.
struct Corners {
  vec3 view[3];
  vec4 clip[3];
  vec3 window[3];  // pixels and 1, or pixels times w and w
  bool resolved;   // the first, for all of them
};

Corners cornersOf(int first) {
  Corners corners;
  corners.resolved = true;
  for (int k = 0; k < 3; ++k) {
    vec3 pView = viewOf(positionAt(first + k), uvAt(first + k));
    vec4 clip = clipOf(pView);
    precise vec2 ndc = clip.xy / clip.w;
    precise vec2 pixels = (vec2(ndc.x, -ndc.y) * 0.5f + 0.5f) * viewport;
    bool resolved = clip.w > 0.0f && abs(pixels.x) < kLargestWindow && abs(pixels.y) < kLargestWindow;
    precise vec2 homogeneous = (vec2(clip.x, -clip.y) * 0.5f + 0.5f * clip.w) * viewport;
    corners.view[k] = pView;
    corners.clip[k] = clip;
    corners.window[k] = resolved ? vec3(pixels, 1.0f) : vec3(homogeneous, clip.w);
    corners.resolved = corners.resolved && resolved;
  }
  return corners;
}

// A corner grown: its weights on the triangle, and where it comes to lie.
struct FloatCorner {
  vec3 share;
  vec2 window;
  bool found;
};

FloatCorner growInFloat(Corners corners, int corner) {
  FloatCorner result;
  result.share = vec3(0.0f);
  result.window = vec2(0.0f);
  result.found = false;
  if (!corners.resolved) return result;
  vec2 window[3] = {corners.window[0].xy, corners.window[1].xy, corners.window[2].xy};
  float area = crossOf(window[1] - window[0], window[2] - window[0]);
  if (abs(area) < 1e-3f) return result;
  float turn = area > 0.0f ? 1.0f : -1.0f;
  vec2 ahead = normalize(window[(corner + 1) % 3] - window[corner]);
  vec2 behind = normalize(window[corner] - window[(corner + 2) % 3]);
  vec2 outAhead = turn * vec2(ahead.y, -ahead.x), outBehind = turn * vec2(behind.y, -behind.x);
  float blunt = 1.0f + dot(outAhead, outBehind);
  if (!(blunt * (kLongestMitre * kLongestMitre) >= 2.0f * kGrow * kGrow)) return result;
  vec2 mitre = (outAhead + outBehind) * (kGrow / blunt);
  vec2 grown = window[corner] + mitre;

  float w[3] = {corners.clip[0].w, corners.clip[1].w, corners.clip[2].w};
  vec3 share = vec3(crossOf(window[1] - grown, window[2] - grown), crossOf(window[2] - grown, window[0] - grown),
                    crossOf(window[0] - grown, window[1] - grown)) / area;
  share /= vec3(w[0], w[1], w[2]);
  float sum = share.x + share.y + share.z;
  float nearest = 1.0f / max(max(w[0], w[1]), w[2]);
  if (!(sum > 0.25f * nearest)) return result;  // the plane turns away from the eye before it gets there
  result.share = share / sum;
  result.window = grown;
  result.found = true;
  return result;
}

// The same in double precision, on lines of homogeneous window coordinates: for needles, for triangles much smaller
// than a pixel, for what passes behind the eye. Also this corner's clip coordinates but for z.
struct DoubleCorner {
  vec3 share;
  vec4 clip;
};

// By `grow` pixels. False where the triangle's plane turns away from the eye before it gets there.
bool growBy(double grow, dvec3 h[3], int corner, double volume, out dvec3 share, out dvec3 grown) {
  double turn = volume > 0.0lf ? 1.0lf : -1.0lf;
  dvec3 before = turn * cross(h[(corner + 2) % 3], h[corner]), after = turn * cross(h[corner], h[(corner + 1) % 3]);
  before.z += grow * length(before.xy);
  after.z += grow * length(after.xy);
  grown = turn * cross(before, after);
  dvec3 mine = h[corner];
  if (mine.z > 0.0lf && grown.z > 0.0lf) {
    dvec2 from = mine.xy / mine.z, way = grown.xy / grown.z - from;
    double away = length(way);
    if (away > double(kLongestNeedle)) grown = dvec3(from + way * (double(kLongestNeedle) / away), 1.0lf) * mine.z;
  }
  share = dvec3(dot(grown, cross(h[1], h[2])), dot(grown, cross(h[2], h[0])), dot(grown, cross(h[0], h[1]))) / volume;
  double sum = share.x + share.y + share.z;
  double farthest = max(abs(h[0].z), max(abs(h[1].z), abs(h[2].z)));
  if (!(sum > 0.0lf && abs(grown.z) < 4.0lf * farthest * sum)) return false;
  share /= sum;
  grown /= sum;
  return true;
}

DoubleCorner growInDouble(Corners corners, int corner) {
  dvec3 h[3];  // pixels times w, about this corner where all are in the window
  dvec2 about = corners.resolved ? dvec2(corners.window[corner].xy) : dvec2(0.0lf);
  for (int k = 0; k < 3; ++k) {
    double w = double(corners.clip[k].w);
    dvec3 window = dvec3(corners.window[k]);
    // Of a corner in the window these are the pixels that the cut knows.
    h[k] = window.z == 1.0lf ? dvec3((window.xy - about) * w, w) : dvec3(window.xy - about * window.z, window.z);
  }
  DoubleCorner result;
  result.share = vec3(corner == 0 ? 1.0f : 0.0f, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f);
  result.clip = corners.clip[corner];
  double volume = dot(h[0], cross(h[1], h[2]));
  if (volume == 0.0lf) return result;
  dvec3 share, grown;
  bool found = false;
  if (corners.resolved) {
    for (float grow = kGrow; !found && grow >= kLeastGrow; grow *= 0.5f)
      found = growBy(double(grow), h, corner, volume, share, grown);
  } else {
    // An edge that passes the eye is seen on the far side of its end: all corners move by the same.
    for (float grow = kGrowFar; !found && grow >= kLeastGrow; grow *= 0.5f) {
      found = true;
      for (int k = 1; k <= 3; ++k)
        found = found && growBy(double(grow), h, (corner + k) % 3, volume, share, grown);
    }
  }
  if (!found) return result;
  grown.xy += about * grown.z;
  dvec2 ndc = 2.0lf * grown.xy / dvec2(viewport);  // from the left and the top, times w
  result.share = vec3(share);
  result.clip = vec4(ndc.x - grown.z, grown.z - ndc.y, 0.0lf, grown.z);
  return result;
}

float windingOf(vec3 a, vec3 b, vec3 c) {
  precise double volume = dot(dvec3(a), cross(dvec3(b), dvec3(c)));
  if (a.z == 1.0f && b.z == 1.0f && c.z == 1.0f) {
    precise dvec2 ab = dvec2(b.xy) - dvec2(a.xy), ac = dvec2(c.xy) - dvec2(a.xy);
    volume = ab.x * ac.y - ab.y * ac.x;
  }
  return volume > 0.0lf ? 1.0f : volume < 0.0lf ? -1.0f : 0.0f;
}

// Fetches this corner, grown, and hands the true corners to the fragment stage.
void placeCorner() {
  int corner = gl_VertexID % 3, first = gl_VertexID - corner;
  Corners corners = cornersOf(first);
  corner0 = vec4(corners.window[0], -corners.view[0].z);
  corner1 = vec4(corners.window[1], -corners.view[1].z);
  corner2 = vec4(corners.window[2], -corners.view[2].z);
  winding = windingOf(corners.window[0], corners.window[1], corners.window[2]);
  bool finite = true;
  for (int k = 0; k < 3; ++k) finite = finite && all(lessThan(abs(corners.window[k]), vec3(kUncut)));
  if (!finite) {
    corner0.x = kUncut;
    fetchVertex(first, vec3(corner == 0, corner == 1, corner == 2));
    viewPosition = viewOf(position, uv);
    gl_Position = clipOf(viewPosition);
    return;
  }
  FloatCorner inFloat = growInFloat(corners, corner);
  if (inFloat.found) {
    fetchVertex(first, inFloat.share);
    viewPosition = viewOf(position, uv);
    gl_Position = clipOf(viewPosition);
    // Far from their object's origin the mean of positions is too coarse: it has to lie where the corner was grown to.
    vec2 there = (vec2(gl_Position.x, -gl_Position.y) / gl_Position.w * 0.5f + 0.5f) * viewport;
    if (length(there - inFloat.window) < 0.25f * kGrow) return;
  }
  DoubleCorner grown = growInDouble(corners, corner);
  fetchVertex(first, grown.share);
  // From corners in view space, where what is far from its object's origin has its precision back.
  viewPosition = grown.share.x * corners.view[0] + grown.share.y * corners.view[1] + grown.share.z * corners.view[2];
  gl_Position = vec4(grown.clip.xy, clipOf(viewPosition).z, grown.clip.w);
}
#endif

void main() {
#ifdef EXACT_COVERAGE
  placeCorner();
#else
  viewPosition = viewOf(position - objectOrigin, uv);
  gl_Position = clipOf(viewPosition);
#endif
  viewNormal = normalFromObject * normal;
  textureUv = uv;
#ifdef VERTEX_COLOUR
  vertexColour = colour * instanceColour;
#else
  vertexColour = colour;
#endif
#ifdef NORMAL_TEXTURE
#ifndef EXACT_COVERAGE
  vec4 tangent = unpackTangent(packedTangent);
#endif
  viewTangent = vec4(mat3(viewFromOffset) * tangent.xyz, tangent.w);
#endif
}
