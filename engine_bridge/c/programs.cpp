#include "engine_bridge/c/programs.h"

#include "engine_bridge/c/glsl_text.h"

namespace pellucid::c {
namespace {

std::string attach(const GlFunctions& gl, GLuint program, GLenum kind, const std::string& text) {
  const GLuint shader = gl.CreateShader(kind);
  const char* source = text.c_str();
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint done = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  char log[400] = {};
  if (done != GL_TRUE) gl.GetShaderInfoLog(shader, sizeof(log) - 1, nullptr, log);
  gl.AttachShader(program, shader);
  gl.DeleteShader(shader);  // lives on while attached
  return done == GL_TRUE ? std::string() : std::string(log) + " ";
}

}  // namespace

std::string Program::build(const GlFunctions& gl, const std::string& file, const std::vector<std::string>& defines) {
  const int version = gl.version >= 45 ? 450 : gl.version >= 43 ? 430 : gl.version >= 40 ? 400 : 330;
  const OwnText stage = ownText(file, defines, version);
  name = gl.CreateProgram();
  std::string failure = attach(gl, name, GL_VERTEX_SHADER, ownText("gl/fullscreen.vert", {}, version).text);
  failure += attach(gl, name, GL_FRAGMENT_SHADER, stage.text);
  if (failure.empty()) {
    gl.LinkProgram(name);
    GLint done = GL_FALSE;
    gl.GetProgramiv(name, GL_LINK_STATUS, &done);
    char log[400] = {};
    if (done != GL_TRUE) {
      gl.GetProgramInfoLog(name, sizeof(log) - 1, nullptr, log);
      failure = std::string("does not link: ") + log;
    }
  }
  if (!failure.empty()) {
    destroy(gl);
    return file + ": " + failure;
  }
  gl.UseProgram(name);
  for (const SamplerUnit& sampler : stage.samplers)
    gl.Uniform1i(gl.GetUniformLocation(name, sampler.name.c_str()), sampler.unit);
  return {};
}

GLint Program::place(const GlFunctions& gl, const char* uniform) const {
  for (Kept& one : kept_) {
    if (one.uniform == uniform) return one.place;
    if (one.uniform) continue;
    one = {uniform, gl.GetUniformLocation(name, uniform)};
    return one.place;
  }
  return gl.GetUniformLocation(name, uniform);
}

void Program::destroy(const GlFunctions& gl) {
  for (Kept& one : kept_) one = {};
  if (name) gl.DeleteProgram(name);
  name = 0;
}

}  // namespace pellucid::c
