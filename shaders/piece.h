// Opens shaders/shared/piece.glsl to C++, as shading.h does with what more files need.
#pragma once
#include "shaders/shading.h"

namespace pellucid::shading {
#define PLD_FN inline
#define precise
#include "shaders/shared/piece.glsl"
#undef precise
#undef PLD_FN
}  // namespace pellucid::shading
