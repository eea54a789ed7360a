// Where refracting surfaces of one ray show the background from, as the model states it: PT17 eqs. 8-10 with the mean
// of what all of them displace. Includes nothing of Pellucid's.
#pragma once
#include <array>
#include <vector>

#include "tests/reference/picture_scene.h"

namespace pellucid::reference {

// A surface that a ray enters. In the eye's own space: it looks down -z.
struct Bend {
  Vec3 at, toEye, normal;  // unit; the normal on the side of the eye
  Vec3 index{1.0};         // for red, green and blue
  double thickness = 0.0;  // metres along the normal
  double weight = 0.0;     // in the mean
};

// Of red, green and blue.
struct Landing {
  std::array<Vec2, 3> offset{};  // pixels, y down
  double z = 0.0;                // mean planar depth of what displaces
  double reach = 0.0;            // pixels from the picture's middle that its numbers go to
};

// What a dispersive medium's index is for red, green and blue. KHR_materials_dispersion
Vec3 dispersedIndex(double index, double dispersion);

// At least one bend.
//   backgroundZ  planar metres, infinite where nothing is
//   tilt         of all normals, radians to the right and upwards
Landing landingOf(const Eye& eye, const Bending& bending, const std::vector<Bend>& bends, double backgroundZ,
                  Vec2 tilt = Vec2(0.0));

// Part of unpolarised light that a smooth dielectric reflects.
//   cosine  of the angle outside, above 0
double reflectedPart(double cosine, double index);

}  // namespace pellucid::reference
