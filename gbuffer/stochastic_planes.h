// What the samples of one pass of stochastic transparency add up to, pixel by pixel: averages over its samples, before
// ST10's division.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "gbuffer/image.h"

namespace pellucid {

struct StochasticPlanes {
  Window data;                                       // display coordinates
  Image<glm::vec3> light, unit, added, empty, beta;  // as StochasticSums in composite/methods/stochastic.h
  Image<glm::vec4> solid;  // nearest fragment that hides everything: rgb, planar z (+inf: none)
  Image<float> frontZ;     // nearest layer, planar metres, +inf for none
};

}  // namespace pellucid
