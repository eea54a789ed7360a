// The shaders of shaders/gl as text, for the library's own programs and for the host's: GLSL 3.30 to 4.60, and for
// recipes ES 3.20 and Vulkan's.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/pass_permutation.h"
#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::c {

struct SamplerUnit {
  std::string name;
  int unit;
};

struct OwnText {
  std::string text;  // with its #version line
  std::vector<SamplerUnit> samplers;
};

// A stage of the GL pass's own, with loose uniforms.
OwnText ownText(const std::string& file, const std::vector<std::string>& defines, int version);

// Who compiles a text.
struct GlslTarget {
  pld_dialect dialect = PLD_DIALECT_GL;
  int version = 330;
  int set = 0;  // Vulkan: of every binding
  // Below GLSL 4.20 places are connected by name.
  bool placesBindings() const { return dialect != PLD_DIALECT_GL || version >= 420; }
};

// A full-screen stage of a recipe, with its #version line.
//   block    what stands in place of the loose uniforms, empty for none
//   storage  binding of the first storage block
std::string recipeStageText(const std::string& file, const std::vector<std::string>& defines, const GlslTarget& target,
                            const std::string& block, int storage);
// As in `layout(std140, binding = 3)`, as far as the target has it.
std::string layoutText(const GlslTarget& target, const char* packing, int binding);

// Where a host's program finds what the library binds, or has it bind.
struct SeamPlaces {
  int uniformBinding, firstUnit, firstStorage = 0;
};

// What shaders/gl/exact_lists.glsl and listed_marks.glsl look for: blocks at storage bindings `first` and after.
constexpr int kListBlocks = 6;
std::vector<std::string> storageDefines(int first);

// Texts for hosts, without a #version line. Names that the host does not call begin with pld_, so that they meet none
// of its own; a shader may hold several of the texts.
// Below GLSL 4.20 units and bindings are left to pld_connect().
// What validation knows a text by: the name of a number in its block, which no other stage or permutation has. The same
// for every version and place.
std::string seamMark(const Permutation& permutation, pld_stage stage);
const char* casterMark(bool coloured);
std::string seamText(const Permutation& permutation, pld_stage stage, const GlslTarget& target,
                     const SeamPlaces& places);
std::string casterText(bool coloured, const GlslTarget& target, const SeamPlaces& places);

// How shadow maps lie.
struct ShadowShape {
  int lights, faces, edge, channels;  // edge: texels as looked up
};
std::string shadowText(const ShadowShape& shape, const GlslTarget& target, const SeamPlaces& places);

}  // namespace pellucid::c
