#include "engine_bridge/c/stage_plan.h"

#include <algorithm>

namespace pellucid::c {

const char* nameOf(pld_stage stage) {
  static constexpr const char* names[] = {"PLD_STAGE_SOLIDS", "PLD_STAGE_FRONT", "PLD_STAGE_LAYERS",
                                          "PLD_STAGE_RIMS",   "PLD_STAGE_LOW",   "PLD_STAGE_CASTERS"};
  return names[stage];
}

uint32_t stagesOf(const Permutation& p) {
  uint32_t stages = 1u << PLD_STAGE_LAYERS;
  if (p.has(PLD_FEATURE_SOLIDS)) stages |= 1u << PLD_STAGE_SOLIDS;
  if (p.frontStage()) stages |= 1u << PLD_STAGE_FRONT;
  if (p.rimsApart()) stages |= 1u << PLD_STAGE_RIMS;
  if (p.low()) stages |= 1u << PLD_STAGE_LOW;
  return stages;
}

pld_stage firstStageOf(const Permutation& p) {
  int stage = 0;
  while (!(stagesOf(p) >> stage & 1u)) ++stage;
  return static_cast<pld_stage>(stage);
}

Permutation lowPermutation(const Permutation& permutation) {
  Permutation low = permutation;
  low.atLowResolution = true;
  low.method = PLD_METHOD_WEIGHTED;  // of one texel
  low.features &= ~static_cast<uint32_t>(PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_OUTPUTS |
                                         PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY);
  return low;
}

ListSizes listSizes(int width, int height, uint64_t fragments) {
  const uint64_t heads = 1 + static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  return {4 * heads, 4 * (heads + fragments), 16 * fragments};
}

namespace {

// All that the stage of the layers draws to.
std::vector<PlaneSpec> blendedPlanes(const Permutation& p) {
  std::vector<PlaneSpec> planes = planesOf(p);
  if (p.exact()) return planes;
  for (const PlaneSpec& plane : pellucid::planesOf(modelOf(p), PlaneStage::marks)) planes.push_back(plane);
  return planes;
}

}  // namespace

bool queryOf(const Permutation& p, pld_value what, uint64_t& value) {
  switch (what) {
    case PLD_VALUE_BITS_PER_PIXEL:
      value = static_cast<uint64_t>(pellucid::bitsOf(blendedPlanes(p)));
      return true;
    case PLD_VALUE_PLANES:
      value = blendedPlanes(p).size();
      return true;
    case PLD_VALUE_GEOMETRY_PASSES:
      value = 1u + (p.frontStage() ? 1u : 0u) + (p.has(PLD_FEATURE_SOLIDS) ? 1u : 0u) + (p.rimsApart() ? 1u : 0u);
      return true;
    default:
      return false;
  }
}

}  // namespace pellucid::c
