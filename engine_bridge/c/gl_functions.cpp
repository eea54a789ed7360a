#include "engine_bridge/c/gl_functions.h"

#include <cstring>

namespace pellucid::c {
namespace {

template <class F>
void ask(pld_get_proc_address get, void* user, const char* name, F& function) {
  function = reinterpret_cast<F>(get(user, name));
}

bool has(const GlFunctions& gl, const char* extension) {
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const GLubyte* name = gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
    if (name && std::strcmp(reinterpret_cast<const char*>(name), extension) == 0) return true;
  }
  return false;
}

}  // namespace

std::string load(pld_get_proc_address get, void* user, GlFunctions& gl) {
  PFNGLGETSTRINGPROC getString = nullptr;
  ask(get, user, "glGetString", getString);
  const GLubyte* text = getString ? getString(GL_VERSION) : nullptr;
  if (!text) return "OpenGL 3.3: found no context that is current on this thread";
  const char* missing = nullptr;
#define PLD_GL_ASK(name, type)         \
  ask(get, user, "gl" #name, gl.name); \
  if (!gl.name && !missing) missing = "gl" #name;
  PLD_GL_REQUIRED(PLD_GL_ASK)
#undef PLD_GL_ASK
  const std::string found = reinterpret_cast<const char*>(text);
  if (missing) return std::string("OpenGL 3.3: found '") + found + "' without " + missing;
  GLint major = 0, minor = 0, profile = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  gl.version = 10 * major + minor;
  if (found.rfind("OpenGL ES", 0) == 0 || gl.version < 33) return "OpenGL 3.3: found '" + found + "'";
  gl.GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  gl.core = (profile & GL_CONTEXT_CORE_PROFILE_BIT) != 0;

  if (const GLubyte* renderer = getString(GL_RENDERER)) {
    const std::string name = reinterpret_cast<const char*>(renderer);
    gl.onProcessor = name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
  }
  GLint buffers = 0;
  gl.GetIntegerv(GL_MAX_DRAW_BUFFERS, &buffers);
  gl.fewBuffers = buffers <= kDrawBuffers;
  gl.clipControl = gl.version >= 45 || has(gl, "GL_ARB_clip_control");

  // A loader may hand out addresses of functions that the context does not have.
  const auto later = [&](bool there, const char* name, auto& function) {
    if (there) ask(get, user, name, function);
  };
  const bool blend = gl.version >= 40, debug = gl.version >= 43 || has(gl, "GL_KHR_debug");
  later(blend, "glBlendEquationSeparatei", gl.BlendEquationSeparatei);
  later(blend, "glBlendFuncSeparatei", gl.BlendFuncSeparatei);
  if (!blend && has(gl, "GL_ARB_draw_buffers_blend")) {
    ask(get, user, "glBlendEquationSeparateiARB", gl.BlendEquationSeparatei);
    ask(get, user, "glBlendFuncSeparateiARB", gl.BlendFuncSeparatei);
  }
  if (!gl.BlendEquationSeparatei || !gl.BlendFuncSeparatei)
    return "blending per draw buffer (OpenGL 4.0 or GL_ARB_draw_buffers_blend): found '" + found + "' without it";
  later(gl.version >= 41 || has(gl, "GL_ARB_viewport_array"), "glGetFloati_v", gl.GetFloati_v);
  later(gl.version >= 41 || has(gl, "GL_ARB_viewport_array"), "glViewportIndexedf", gl.ViewportIndexedf);
  // What a texture is, Mesa says in core contexts alone.
  later(gl.core && (gl.version >= 45 || has(gl, "GL_ARB_direct_state_access")), "glGetTextureParameteriv",
        gl.GetTextureParameteriv);
  later(gl.version >= 45 || has(gl, "GL_ARB_texture_barrier"), "glTextureBarrier", gl.TextureBarrier);
  const bool lists = gl.version >= 43;
  later(lists, "glClearBufferSubData", gl.ClearBufferSubData);
  later(lists, "glGetBufferSubData", gl.GetBufferSubData);
  later(lists, "glGetInteger64v", gl.GetInteger64v);
  later(lists, "glMemoryBarrier", gl.MemoryBarrier);
  later(debug, "glGetObjectLabel", gl.GetObjectLabel);
  later(debug, "glObjectLabel", gl.ObjectLabel);
  later(debug, "glPushDebugGroup", gl.PushDebugGroup);
  later(debug, "glPopDebugGroup", gl.PopDebugGroup);
  return {};
}

}  // namespace pellucid::c
