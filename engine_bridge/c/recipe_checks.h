// Whether there is a recipe of a host's choices: one sentence for each thing that cannot be.
#pragma once
#include <new>
#include <stdexcept>

#include "engine_bridge/c/pass_permutation.h"
#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::c {

constexpr uint32_t kMostBinding = 1u << 20;  // as far as any device goes; sums of them stay numbers

// Says why to info.message, and returns the status.
pld_status refuse(const pld_recipe_info& info, pld_status status, const char* text);
// The permutation of an info that may have a recipe, with what it fixes.
pld_status takeInfo(const pld_recipe_info& info, Permutation& permutation);

// What make() returns; what it throws is said to info.message.
template <class F>
pld_status guardedMake(const pld_recipe_info& info, const char* memory, F make) noexcept {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    return refuse(info, PLD_ERROR_MEMORY, memory);
  } catch (const std::exception& mistake) {
    return refuse(info, PLD_ERROR_INTERNAL, mistake.what());
  } catch (...) {
    return PLD_ERROR_INTERNAL;
  }
}

}  // namespace pellucid::c
