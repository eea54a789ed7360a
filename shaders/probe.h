// Opens shaders/shared/probe.glsl to C++, as shading.h does with what more files need.
#pragma once
#include <glm/glm.hpp>

namespace pellucid::shading {
using namespace glm;  // NOLINT: the shared text speaks GLSL
#define PLD_FN inline
#include "shaders/shared/probe.glsl"
#undef PLD_FN
}  // namespace pellucid::shading
