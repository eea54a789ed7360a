// Opens shaders/shared to C++: the same text that GL compiles, through GLM, in namespace pellucid::shading.
#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace pellucid::shading {
using namespace glm;  // NOLINT: the shared text speaks GLSL
using glm::floatBitsToInt;
using glm::intBitsToFloat;

#define PLD_FN inline
#define precise
#include "shaders/shared/accumulate.glsl"
#include "shaders/shared/diffusion.glsl"
#include "shaders/shared/environment.glsl"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/lights.glsl"
#include "shaders/shared/material.glsl"
#include "shaders/shared/numeric.glsl"
#include "shaders/shared/occlusion.glsl"
#include "shaders/shared/published.glsl"
#include "shaders/shared/refraction.glsl"
#include "shaders/shared/resolve.glsl"
#include "shaders/shared/scattering.glsl"
#include "shaders/shared/shadow.glsl"
#include "shaders/shared/stochastic.glsl"
#include "shaders/shared/surface.glsl"
#include "shaders/shared/weight.glsl"
#undef precise
#undef PLD_FN
}  // namespace pellucid::shading
