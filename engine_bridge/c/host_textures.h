// The host's textures, asked before they are used; nothing here leaves a GL error behind.
#pragma once
#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

struct TextureFacts {
  GLint width = 0, height = 0, format = 0;
};

// False when `name` is no 2D texture of this context with storage at level 0. Uses and puts back the active unit's
// binding.
bool factsOf(const GlFunctions& gl, GLuint name, TextureFacts& facts);
// What a name is for which factsOf() is false, as a sentence ends: "no texture of this context", "a
// GL_TEXTURE_2D_ARRAY".
const char* kindOf(const GlFunctions& gl, GLuint name);

// How `format` serves as depth, or 0: GL_DEPTH_ATTACHMENT or GL_DEPTH_STENCIL_ATTACHMENT.
GLenum depthAttachment(GLint format);
bool isLinearDepth(GLint format);  // red of a float texture
bool isOcclusion(GLint format);    // red of whatever holds numbers from 0 to 1
bool isColour(GLint format);       // what a background or a target may be

}  // namespace pellucid::c
