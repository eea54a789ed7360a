// What is wrong with a recipe, as far as a pass tells.
#pragma once
#include <cstdint>
#include <set>
#include <string>

#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::test {

int bitsOf(pld_format format);

// What is wrong with one pass, given what was written before it; adds what it writes. Empty for nothing.
std::string faultOf(const pld_recipe& recipe, const pld_recipe_pass& pass, std::set<uint32_t>& written);

}  // namespace pellucid::test
