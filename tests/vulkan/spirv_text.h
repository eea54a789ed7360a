// GLSL to SPIR-V by glslang, checked by SPIRV-Tools, and what of its declarations is used.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::test {

struct SpirvText {
  std::string failure;                                  // of the compiler or the validator; empty for none
  std::map<std::string, std::pair<int, int>> samplers;  // name: set and binding
  std::map<std::string, std::pair<int, int>> storage;   // likewise
  std::string block;                                    // uniform block, its set, binding and bytes
  int blockSet = -1, blockBinding = -1, blockBytes = 0;
  std::set<int> outputs;  // locations
};

enum class TextKind { vulkan, es };
// A fragment or vertex shader with its #version line. ES is compiled, and not looked into.
SpirvText compiledText(const std::string& text, bool vertex, TextKind kind);

}  // namespace pellucid::test
