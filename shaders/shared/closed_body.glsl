#pragma once
// Refraction through a closed body whose shape is known: a ray is bent where it enters and again where it leaves, so
// that a ball turns what is behind it upside down and a slab moves it aside. PT17 eqs. 8-10 at both faces.
#include "shared/refraction.glsl"

const int PLD_BODY_NONE = 0;
const int PLD_BODY_BALL = 1;  // the unit ball in the body's own space
const int PLD_BODY_BOX = 2;   // [-1,1]^3

struct ClosedBody {
  int kind;       // PLD_BODY_*
  mat4 fromView;  // view space to the body's own
};

// Where a ray inside leaves.
struct Leaving {
  float way;      // metres along the ray, >= 0
  vec3 outwards;  // normal there, view space, any length
};

//   pView   a point of the surface, view space, metres
//   inside  unit
PLD_FN Leaving leavingBody(ClosedBody body, vec3 pView, vec3 inside) {
  vec3 at = vec3(body.fromView * vec4(pView, 1.0f));
  vec3 along = vec3(body.fromView * vec4(inside, 0.0f));
  Leaving leaving;
  vec3 gradient = vec3(0.0f);
  if (body.kind == PLD_BODY_BALL) {
    float a = max(dot(along, along), 1e-30f), b = dot(at, along), c = dot(at, at) - 1.0f;
    leaving.way = max((sqrt(max(b * b - a * c, 0.0f)) - b) / a, 0.0f);
    gradient = at + leaving.way * along;
  } else {
    leaving.way = 1e30f;
    for (int axis = 0; axis < 3; ++axis) {
      if (along[axis] == 0.0f) continue;
      float side = along[axis] > 0.0f ? 1.0f : -1.0f;
      float way = max((side - at[axis]) / along[axis], 0.0f);
      if (way >= leaving.way) continue;
      leaving.way = way;
      gradient = vec3(0.0f);
      gradient[axis] = side;
    }
  }
  leaving.outwards = vec3(dot(vec3(body.fromView[0]), gradient), dot(vec3(body.fromView[1]), gradient),
                          dot(vec3(body.fromView[2]), gradient));
  return leaving;
}

// As refractionOffset(). What is reflected inside goes on as it went.
PLD_FN vec2 bodyOffset(RefractionSettings settings, ClosedBody body, vec3 pView, vec3 toEye, vec3 normal, float eta,
                       float backgroundZ) {
  if (eta == 1.0f || reflectsAll(toEye, normal, eta)) return vec2(0.0f);
  vec3 inside = refractedDirection(toEye, normal, eta);
  Leaving leaving = leavingBody(body, pView, inside);
  float size = dot(leaving.outwards, leaving.outwards);
  if (!(size > 0.0f && size < 3e38f)) return vec2(0.0f);  // smaller or larger than floats can say
  vec3 leaves = pView + leaving.way * inside;
  vec3 inwards = -leaving.outwards / sqrt(size);
  vec3 beyond = inside;
  if (!reflectsAll(-inside, inwards, 1.0f / eta)) beyond = refractedDirection(-inside, inwards, 1.0f / eta);
  float behind = backgroundZ + leaves.z;
  float reach = refractionReach(settings, -pView.z);
  if (!(behind < reach)) behind = reach;
  vec3 reached = leaves + beyond * (max(behind, 0.0f) / max(-beyond.z, PLD_LEAST_FORWARD));
  vec2 offset = fromPrincipalPoint(settings, reached) - fromPrincipalPoint(settings, pView);
  return clamp(offset, vec2(-PLD_LARGEST_OFFSET), vec2(PLD_LARGEST_OFFSET));
}
