// GL programs made from shaders/gl, one per set of defines, kept once linked: all passes over a context share them.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine_bridge/gl/gl_objects.h"

namespace pellucid::gl {

struct Program {
  ProgramName name;
  // Locations of the plain uniforms, -1 where this permutation has no use for one; GL ignores writes to -1.
  GLint viewFromOffset = -1, objectOrigin = -1, normalFromObject = -1, thicknessScale = -1, instanceColour = -1;
  GLint instanceIdentity = -1, turn = -1, pointScale = -1, maskResolved = -1;
  GLint bodyKind = -1, bodyFromView = -1;

  // Of the program in use. As placedNearEye() has it.
  void placeObject(const glm::dmat4& viewFromObject, double nearest) const;
};

// Throws std::logic_error with the compiler's log: shaders are ours, not the user's.
Program buildProgram(const std::string& vertexStage, const std::string& fragmentStage,
                     const std::vector<std::string>& defines);

class ProgramCache {
 public:
  const Program& get(const std::string& vertexStage, const std::string& fragmentStage,
                     const std::vector<std::string>& defines);

 private:
  std::unordered_map<std::string, Program> programs_;
};

// Of the context that is current. Throws std::logic_error where GlContext did not make it.
ProgramCache& programs();

}  // namespace pellucid::gl
