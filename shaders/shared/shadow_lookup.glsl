#pragma once
// Looking shadow maps up. Whoever includes this says where maps come from:
//   ShadowLight shadowLight(int light)
//   ShadowFace shadowFace(int face)
//   vec4 shadowTexel(int index)  of one channel of a transparent face, or four neighbours of an opaque one
#include "shared/shadow_map.glsl"

PLD_FN float shadowDepthOf(ShadowLight light, vec3 point) {
  if (light.lookup.w == 0) return dot(vec3(light.metric), point) + light.metric.w;
  return length(point - vec3(light.metric)) * light.metric.w;
}

// Position in a face's texels, centres at + 0.5; z is 0 outside.
PLD_FN vec3 shadowPosition(ShadowFace face, vec3 point) {
  vec4 place = face.mapFromView * vec4(point, 1.0f);
  if (!(place.w > 0.0f)) return vec3(0.0f);
  float x = place.x / place.w;
  float y = place.y / place.w;
  bool inside = x >= face.inner.x && x < face.inner.y && y >= face.inner.x && y < face.inner.y;
  return vec3(x, y, inside ? 1.0f : 0.0f);
}

PLD_FN vec4 shadowTexelAt(ShadowFace face, int x, int y, int channel) {
  int last = face.extent.y - 1;
  int u = clamp(x, 0, last);
  int v = clamp(y, 0, last);
  return shadowTexel(face.extent.x + (v * face.extent.y + u) * face.extent.z + channel);
}

PLD_FN vec4 shadowBilinear(ShadowFace face, vec3 place, int channel) {
  float x = place.x - 0.5f;
  float y = place.y - 0.5f;
  int u = int(floor(x));
  int v = int(floor(y));
  float fx = x - float(u);
  float fy = y - float(v);
  vec4 top = shadowTexelAt(face, u, v, channel) * (1.0f - fx) + shadowTexelAt(face, u + 1, v, channel) * fx;
  vec4 low = shadowTexelAt(face, u, v + 1, channel) * (1.0f - fx) + shadowTexelAt(face, u + 1, v + 1, channel) * fx;
  return top * (1.0f - fy) + low * fy;
}

// What the texels of a square hide, those that cast, and those that cast before `depth`.
PLD_FN vec3 shadowCloser(ShadowFace face, vec3 place, int channel, int edge, float depth) {
  int u = int(floor(place.x - 0.5f * float(edge) + 0.5f));
  int v = int(floor(place.y - 0.5f * float(edge) + 0.5f));
  vec3 sum = vec3(0.0f);
  for (int j = 0; j < edge; ++j)
    for (int i = 0; i < edge; ++i) {
      vec4 texel = shadowTexelAt(face, u + i, v + j, channel);
      sum += vec3(texel.x, texel.y, depth > texel.z ? texel.y : 0.0f);
    }
  return sum * (1.0f / float(edge * edge));
}

// What transparent casters leave of a light, in one channel. [0,1]
//   standsBehind  the receiver is opaque: casters of its texels lie before it, all of them, or all behind it where the
//                 lookup reaches past the rim of what it stands on
PLD_FN float shadowPassed(ShadowLight light, ShadowFace face, vec3 place, int channel, float depth, bool standsBehind) {
  bool scaled = light.lookup.y != 0;
  float contact = depth + 2.0f * (light.bias.z + light.bias.w * depth);  // at 45 degrees the whole filter's reach
  if (light.lookup.x == PLD_SHADOW_CLOSER) {
    bool whole = scaled && standsBehind;
    vec3 sum = shadowCloser(face, place, channel, light.lookup.z, whole ? contact : depth);
    if (!scaled) return 1.0f - sum.z;
    if (!(sum.y > 0.0f)) return 1.0f - sum.x;
    float share = whole ? (sum.z > 0.0f ? 1.0f : 0.0f) : sum.z / sum.y;
    return 1.0f - sum.x * share;
  }
  vec4 texel = shadowBilinear(face, place, channel);
  if (light.lookup.x == PLD_SHADOW_CHEBYSHEV) return 1.0f - (scaled ? texel.x : texel.y) * casterShare(texel, depth);
  if (!standsBehind) return 1.0f - texel.x * slabShare(texel, depth);
  bool allBehind = texel.y > 0.0f && slabBegin(texel) > contact;
  return allBehind ? 1.0f : 1.0f - texel.x;
}

PLD_FN vec3 transparentVisibility(int lightIndex, vec3 point, bool standsBehind) {
  ShadowLight light = shadowLight(lightIndex);
  float depth = shadowDepthOf(light, point);
  depth -= standsBehind ? 0.0f : light.bias.z + light.bias.w * depth;
  for (int i = 0; i < light.faces.y; ++i) {
    ShadowFace face = shadowFace(light.faces.x + i);
    vec3 place = shadowPosition(face, point);
    if (place.z == 0.0f) continue;
    vec3 passed;
    passed.r = shadowPassed(light, face, place, 0, depth, standsBehind);
    if (face.extent.z == 1) return clamp(vec3(passed.r), vec3(0.0f), vec3(1.0f));
    passed.g = shadowPassed(light, face, place, 1, depth, standsBehind);
    passed.b = shadowPassed(light, face, place, 2, depth, standsBehind);
    return clamp(passed, vec3(0.0f), vec3(1.0f));
  }
  return vec3(1.0f);
}

PLD_FN float opaqueTexelAt(ShadowFace face, int x, int y) {
  int last = face.extent.y - 1;
  int place = clamp(y, 0, last) * face.extent.y + clamp(x, 0, last);
  vec4 four = shadowTexel(face.extent.x + place / 4);
  int part = place % 4;
  return part == 0 ? four.x : part == 1 ? four.y : part == 2 ? four.z : four.w;
}

// Part of the four texels around a receiver that no opaque caster lies before. Williams 1978, percentage closer.
PLD_FN float opaqueVisibility(int lightIndex, vec3 point) {
  ShadowLight light = shadowLight(lightIndex);
  float depth = shadowDepthOf(light, point);
  depth -= light.bias.x + light.bias.y * depth;
  for (int i = 0; i < light.faces.w; ++i) {
    ShadowFace face = shadowFace(light.faces.z + i);
    vec3 place = shadowPosition(face, point);
    if (place.z == 0.0f) continue;
    float x = place.x - 0.5f;
    float y = place.y - 0.5f;
    int u = int(floor(x));
    int v = int(floor(y));
    float fx = x - float(u);
    float fy = y - float(v);
    float a = depth <= opaqueTexelAt(face, u, v) ? 1.0f : 0.0f;
    float b = depth <= opaqueTexelAt(face, u + 1, v) ? 1.0f : 0.0f;
    float c = depth <= opaqueTexelAt(face, u, v + 1) ? 1.0f : 0.0f;
    float d = depth <= opaqueTexelAt(face, u + 1, v + 1) ? 1.0f : 0.0f;
    return (a * (1.0f - fx) + b * fx) * (1.0f - fy) + (c * (1.0f - fx) + d * fx) * fy;
  }
  return 1.0f;
}

// What reaches a point in the air, or on a transparent surface, of a light: the darker of both kinds of shadow.
PLD_FN vec3 shadowVisibility(int lightIndex, vec3 point) {
  return min(transparentVisibility(lightIndex, point, false), vec3(opaqueVisibility(lightIndex, point)));
}
