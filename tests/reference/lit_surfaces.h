// What a surface of glTF shows of lamps and of even surroundings, in double precision: a Lambertian base under a
// dielectric or metal interface of GGX microfacets (glTF 2.0, appendix B), with the exact Fresnel term of the index,
// and KHR_lights_punctual. Includes nothing of Pellucid's.
#pragma once
#include "tests/reference/picture_scene.h"

namespace pellucid::reference {

// At one point, from one side.
struct Finished {
  Vec3 base{1.0};
  double passes = 0.0;  // part of the light that enters and goes through
  double metal = 0.0, roughness = 1.0;
  double index = 1.5;
  bool mirrors = true;  // as a dielectric of that index does
};

// Part of the light that the interface of what is no metal reflects. cosine of the angle outside, above 0
double interfacePart(const Finished& surface, double cosine);
// Part of the light that goes through. Of what the interface lets in, not of what fills the sheet.
Vec3 passedPart(const Finished& surface, double cosine);
// Towards the eye, for light that arrives from everywhere evenly: at the mirror's angle, however rough.
Vec3 reflectedEvenly(const Finished& surface, double cosine);

// What a lamp sends to a point, on a surface that faces it, W/m^2.
struct Sent {
  Vec3 towards;  // the lamp, unit
  Vec3 irradiance;
  double metres;  // infinite of a sun
};
Sent sentBy(const PunctualLamp& lamp, const Vec3& point);

// 1/sr, the cosine included. All directions unit, the normal on the side of the eye.
Vec3 reflectedTowards(const Finished& surface, const Vec3& normal, const Vec3& toEye, const Vec3& toLamp);

// What a surface of a coat leaves of a lamp's light, where that crosses it: PT17 eqs. 11-13 as the model settles them.
//   hidden  of it at the angle, coverage times 1 - transmission
//   cosine  of the angle to the normal, [0,1]
//   index   inside over outside, 1 where nothing fills it
Vec3 leftByCaster(const Vec3& hidden, double cosine, double index);

}  // namespace pellucid::reference
