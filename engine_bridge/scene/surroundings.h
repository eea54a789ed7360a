// A lat-long picture of the surroundings, prepared for shading: the atlas that shaders/shared/environment.glsl looks
// up.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/image.h"
#include "shaders/shading.h"

namespace pellucid {

struct Surroundings {
  int edge = 0;            // texels along level 0
  Image<glm::vec4> atlas;  // levels below each other: reflections by roughness, diffuse light, the table

  // Four texels together: what a GL stage fetches.
  glm::vec4 at(const shading::AtlasTaps& taps) const;
  // What a surface sends of it to the eye.
  //   normal, toEye  world, unit
  glm::vec3 reflected(const shading::Surface& surface, glm::vec3 normal, glm::vec3 toEye, float cosEye) const;
};

// The same bits for every number of threads.
//   latLong  rows from +y down to -y, values finite and >= 0
//   edge     of level 0, a power of two from 32; 0 takes half the picture's width, 1024 at most
Surroundings prepareSurroundings(const Image<glm::vec3>& latLong, int edge = 0);

}  // namespace pellucid
