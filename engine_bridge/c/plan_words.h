// A plan's formats, blending and tests in GL's words.
#pragma once
#include "engine_bridge/c/gl_functions.h"
#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::c {

// Sized internal format; 0 for the host's.
constexpr GLenum wordOf(pld_format format) {
  constexpr GLenum words[] = {0,        GL_R16F,    GL_RG16F, GL_RGBA16F,   GL_R32F,
                              GL_RG32F, GL_RGBA32F, GL_RGBA8, GL_RG8_SNORM, GL_DEPTH_COMPONENT32F};
  return words[format];
}

constexpr GLenum wordOf(pld_factor factor) {
  return factor == PLD_FACTOR_ZERO ? GL_ZERO : factor == PLD_FACTOR_ONE ? GL_ONE : GL_ONE_MINUS_SRC_COLOR;
}

constexpr GLenum wordOf(pld_blend_op op) {
  return op == PLD_BLEND_ADD ? GL_FUNC_ADD : op == PLD_BLEND_MINIMUM ? GL_MIN : GL_FUNC_REVERSE_SUBTRACT;
}

// Not of PLD_COMPARE_NONE.
constexpr GLenum wordOf(pld_compare compare) {
  return compare == PLD_COMPARE_GREATER ? GL_GREATER : compare == PLD_COMPARE_GREATER_OR_EQUAL ? GL_GEQUAL : GL_LEQUAL;
}

}  // namespace pellucid::c
