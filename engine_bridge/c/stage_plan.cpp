#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

uint32_t stagesOf(const Permutation& p) {
  uint32_t stages = 1u << PLD_STAGE_LAYERS;
  if (p.has(PLD_FEATURE_SOLIDS)) stages |= 1u << PLD_STAGE_SOLIDS;
  if (p.frontStage()) stages |= 1u << PLD_STAGE_FRONT;
  if (p.rimsApart()) stages |= 1u << PLD_STAGE_RIMS;
  if (p.low()) stages |= 1u << PLD_STAGE_LOW;
  return stages;
}

Permutation lowPermutation(const Permutation& permutation) {
  Permutation low = permutation;
  low.atLowResolution = true;
  low.method = PLD_METHOD_WEIGHTED;  // of one texel
  low.features &= ~static_cast<uint32_t>(PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_OUTPUTS);
  return low;
}

int listBlocks(const Permutation& p) {
  if (!p.exact()) return 0;
  const bool offsets = p.scatters() || p.rimsApart();
  return p.has(PLD_FEATURE_DISPERSION) ? 5 : offsets ? 4 : 3;
}

}  // namespace pellucid::c
