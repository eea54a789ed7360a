// A recipe as it is handed out: a plan with its texts, in the structs of pellucid/recipe.h.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/glsl_text.h"
#include "engine_bridge/c/recipe_plan.h"

struct pld_recipe {
  // Of checked choices.
  pld_recipe(const pellucid::c::Permutation& permutation, pellucid::c::RecipePlan plan, const pld_recipe_info& info);
  pld_recipe(const pld_recipe&) = delete;
  pld_recipe& operator=(const pld_recipe&) = delete;

  uint32_t version;  // of the host's header
  pellucid::c::Permutation permutation;
  pellucid::c::RecipePlan plan;
  std::vector<pld_recipe_image> images;
  std::vector<pld_recipe_buffer> buffers;
  std::vector<pld_recipe_pass> passes;
  std::string lookup;  // of shadow maps
  uint64_t lookupHash = 0;

 private:
  // What a pass points to.
  struct Kept {
    std::vector<pld_recipe_read> reads;
    std::vector<pld_recipe_storage> storage;
    std::string vertex, fragment;
  };

  void addImages();
  void addSeam(const pellucid::c::PlannedPass& planned, Kept& kept, const pld_recipe_info& info, pld_recipe_pass& pass);
  void addPass(const pellucid::c::PlannedPass& planned, Kept& kept, const pld_recipe_info& info);
  void addLives();

  std::vector<Kept> kept_;
};

namespace pellucid::c {

// Binding of a full-screen pass's numbers, behind all textures; lists come after it.
constexpr int kNumbersBinding = kLookupUnits;

}  // namespace pellucid::c
