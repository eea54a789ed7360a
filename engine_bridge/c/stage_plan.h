// Which stages a pass has, and what each of them fills: pure functions of the permutation.
#pragma once
#include <vector>

#include "engine_bridge/c/pass_permutation.h"

namespace pellucid::c {

constexpr int kStages = 5;  // of pld_stage
// As messages call a stage.
const char* nameOf(pld_stage stage);

// Bits 1 << pld_stage.
uint32_t stagesOf(const Permutation& permutation);
pld_stage firstStageOf(const Permutation& permutation);
// What a texel of PLD_STAGE_LOW keeps: nothing among its layers is solid or waits for its occlusion, and nearest depths
// have a plane.
Permutation lowPermutation(const Permutation& permutation);
// Bytes of the lists of the exact tier, for pictures up to a size with room for so many fragments.
struct ListSizes {
  uint64_t heads, links, record;  // emptied before a stage, which begin the links; all of them; each other block
};
ListSizes listSizes(int width, int height, uint64_t fragments);
constexpr uint64_t kMostFragments = uint64_t{1} << 31;  // as far as shaders/gl/exact_output.glsl counts

// PLD_VALUE_BITS_PER_PIXEL, _PLANES and _GEOMETRY_PASSES; false for other values.
bool queryOf(const Permutation& permutation, pld_value what, uint64_t& value);

}  // namespace pellucid::c
