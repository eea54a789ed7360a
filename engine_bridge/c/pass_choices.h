// What pld_create_info and pld_recipe_info have in common: the choices that make a permutation.
#pragma once
#include <cstdio>

#include "engine_bridge/c/pass_permutation.h"
#include "shaders/weights.h"

namespace pellucid::c {

constexpr uint32_t kEveryFeature = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION |
                                   PLD_FEATURE_DIFFUSION | PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS |
                                   PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION | PLD_FEATURE_OUTPUTS |
                                   PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;

// Whether some choice is none that its enumeration has; `text` then says which.
template <class Info, std::size_t size>
bool nameUnknownChoice(const Info& info, const char* call, char (&text)[size]) {
  const struct {
    const char* name;
    int value, last;
  } choices[] = {{"method", info.method, PLD_METHOD_OVER},
                 {"tier", info.tier, PLD_TIER_EXACT},
                 {"weight", info.weight, static_cast<int>(kDepthWeights.size()) - 1},
                 {"depth", info.depth, PLD_DEPTH_LINEAR},
                 {"clip", info.clip, PLD_CLIP_ZERO_TO_ONE},
                 {"rows", info.rows, PLD_ROWS_DOWN}};
  for (const auto& choice : choices) {
    if (choice.value >= 0 && choice.value <= choice.last) continue;
    std::snprintf(text, size, "%s: %s: found %d, expected 0 to %d", call, choice.name, choice.value, choice.last);
    return true;
  }
  return false;
}

template <class Info>
Permutation permutationOf(const Info& info) {
  Permutation p;
  p.method = info.method;
  p.tier = info.tier;
  p.features = info.features;
  p.weight = info.weight;
  p.depth = info.depth;
  p.rows = info.rows;
  return p;
}

}  // namespace pellucid::c
