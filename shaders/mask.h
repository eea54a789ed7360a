// Opens shaders/shared/mask.glsl to C++, as shading.h does with what more files need.
#pragma once
#include <glm/glm.hpp>

namespace pellucid::shading {
using namespace glm;  // NOLINT: the shared text speaks GLSL
#define PLD_FN inline
#define precise
#include "shaders/shared/mask.glsl"
#undef precise
#undef PLD_FN
}  // namespace pellucid::shading
