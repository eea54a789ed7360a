// The text of every GLSL stage, with its includes resolved, ready for glShaderSource.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

struct ShaderText {
  const char* name;  // path below shaders/, "gl/transparent.frag"
  const char* text;
};
extern const ShaderText kShaderTexts[];  // ends with {nullptr, nullptr}

// "#version 450 core", one "#define" per entry ("NAME" or "NAME VALUE"), then the file and, once each, what it
// includes. Throws std::logic_error for a file that does not exist: a mistake of ours, not of the user.
std::string shaderSource(const std::string& name, const std::vector<std::string>& defines = {});

// The same without the lines before the file: its parts in their order, whole lines of kShaderTexts, where two files
// share the parts of what both include.
std::vector<std::string_view> shaderParts(const std::string& name);

}  // namespace pellucid
