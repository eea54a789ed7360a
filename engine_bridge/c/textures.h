// The host's textures, asked before they are used; nothing here leaves a GL error behind.
#pragma once
#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

struct TextureFacts {
  GLint width = 0, height = 0, format = 0;
};

// False when `name` is no 2D texture of this context with storage at level 0. Uses and puts back unit `unit`'s binding.
bool factsOf(const GlFunctions& gl, GLuint name, TextureFacts& facts);

// How `format` serves as depth, or 0: GL_DEPTH_ATTACHMENT or GL_DEPTH_STENCIL_ATTACHMENT.
GLenum depthAttachment(GLint format);
bool isLinearDepth(GLint format);  // red of a float texture
bool isOcclusion(GLint format);    // red of whatever holds numbers from 0 to 1
bool isColour(GLint format);       // what a background or a target may be

}  // namespace pellucid::c
