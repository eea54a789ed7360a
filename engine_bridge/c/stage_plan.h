// Which stages a pass has, and what each of them fills: pure functions of the permutation.
#pragma once
#include <vector>

#include "engine_bridge/c/pass_permutation.h"

namespace pellucid::c {

constexpr int kStages = 5;  // of pld_stage

// Bits 1 << pld_stage.
uint32_t stagesOf(const Permutation& permutation);
// What a texel of PLD_STAGE_LOW keeps: nothing among its layers is solid or waits for its occlusion, and nearest depths
// have a plane.
Permutation lowPermutation(const Permutation& permutation);
// How many storage blocks the lists of the exact tier take; 0 in other tiers.
int listBlocks(const Permutation& permutation);

}  // namespace pellucid::c
