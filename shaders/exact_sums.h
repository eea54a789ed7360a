// Opens shaders/shared/exact_sums.glsl to C++, as shading.h does with what more files need.
#pragma once
#include <glm/integer.hpp>
#include <glm/packing.hpp>

#include "shaders/shading.h"

namespace pellucid::shading {
using glm::floatBitsToUint;
#define PLD_FN inline
#define precise
#include "shaders/shared/exact_sums.glsl"
#undef precise
#undef PLD_FN
}  // namespace pellucid::shading
