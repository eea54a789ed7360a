// A text of a recipe, and what the recipe says of it.
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>

#include "engine_bridge/include/pellucid/recipe.h"
#include "tests/vulkan/spirv_text.h"

namespace pellucid::test {

// One text and what its recipe says of it.
struct SaidText {
  std::string where, vertex, fragment, block;
  std::map<std::string, std::pair<int, int>> reads, storage;
  std::set<int> outputs;
  int set = 0, constantsBinding = 0, constantsSize = 0;
};

// The #version line that a host's shader has.
std::string versionLine(pld_dialect dialect);
//   head, main  before and behind the text, where the pass is the host's draws
SaidText saidOf(const pld_recipe_pass& pass, const std::string& where, pld_dialect dialect, const std::string& head,
                const std::string& main);
// What a compiler sees otherwise than it is said, and what it refuses; empty for nothing.
std::string faultOf(const SaidText& said, TextKind kind);

}  // namespace pellucid::test
