#include "engine_bridge/gl/gl_program.h"

#include <stdexcept>

#include "engine_bridge/scene/placed.h"
#include "shaders/shader_source.h"

namespace pellucid::gl {
namespace {

void attach(GLuint program, GLenum kind, const std::string& file, const std::vector<std::string>& defines) {
  const std::string source = shaderSource(file, defines);
  const char* text = source.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE, length = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  if (length > 0) glGetShaderInfoLog(shader, length, nullptr, log.data());
  glAttachShader(program, shader);
  glDeleteShader(shader);  // lives on while attached
  if (ok != GL_TRUE) throw std::logic_error(file + " does not compile: " + log);
}

}  // namespace

Program buildProgram(const std::string& vertexStage, const std::string& fragmentStage,
                     const std::vector<std::string>& defines) {
  Program program;
  program.name = ProgramName::make();
  const GLuint name = program.name.name();
  attach(name, GL_VERTEX_SHADER, vertexStage, defines);
  attach(name, GL_FRAGMENT_SHADER, fragmentStage, defines);
  glLinkProgram(name);
  GLint ok = GL_FALSE, length = 0;
  glGetProgramiv(name, GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    glGetProgramiv(name, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    if (length > 0) glGetProgramInfoLog(name, length, nullptr, log.data());
    throw std::logic_error(fragmentStage + " does not link: " + log);
  }
  program.viewFromOffset = glGetUniformLocation(name, "viewFromOffset");
  program.objectOrigin = glGetUniformLocation(name, "objectOrigin");
  program.normalFromObject = glGetUniformLocation(name, "normalFromObject");
  program.thicknessScale = glGetUniformLocation(name, "thicknessScale");
  program.instanceColour = glGetUniformLocation(name, "instanceColour");
  program.instanceIdentity = glGetUniformLocation(name, "instanceIdentity");
  program.pointScale = glGetUniformLocation(name, "pointScale");
  program.maskResolved = glGetUniformLocation(name, "maskResolved");
  program.turn = glGetUniformLocation(name, "turn");
  program.bodyKind = glGetUniformLocation(name, "bodyKind");
  program.bodyFromView = glGetUniformLocation(name, "bodyFromView");
  return program;
}

void Program::placeObject(const glm::dmat4& viewFromObject, double nearest) const {
  const PlacedNearEye placed = placedNearEye(viewFromObject, nearest);
  glUniform3fv(objectOrigin, 1, &placed.origin[0]);
  glUniformMatrix4fv(viewFromOffset, 1, GL_FALSE, &placed.viewFromOffset[0][0]);
}

const Program& ProgramCache::get(const std::string& vertexStage, const std::string& fragmentStage,
                                 const std::vector<std::string>& defines) {
  std::string key = vertexStage + '|' + fragmentStage;
  for (const std::string& define : defines) key += '|' + define;
  auto found = programs_.find(key);
  if (found == programs_.end()) found = programs_.emplace(key, buildProgram(vertexStage, fragmentStage, defines)).first;
  return found->second;
}

}  // namespace pellucid::gl
