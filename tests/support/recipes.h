// Recipes of every permutation of method, tier and features that there is.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "engine_bridge/include/pellucid/recipe.h"

namespace pellucid::test {

struct RecipeEnds {
  void operator()(pld_recipe* recipe) const { pld_recipe_destroy(&recipe); }
};
using RecipePointer = std::unique_ptr<pld_recipe, RecipeEnds>;

// Null where it is refused; `why` is the sentence.
RecipePointer makeRecipe(pld_recipe_info info, std::string* why = nullptr);
// Of shadow maps, likewise.
RecipePointer makeShadowRecipe(pld_recipe_info info, const pld_shadow_info& maps, std::string* why = nullptr);
// Of what a pass does that is created so.
pld_recipe_info recipeInfoLike(const pld_create_info& create, int version);
// Calls found(info, recipe) for each, of a host with reversed depth; returns how many there are.
int forEachRecipe(const pld_recipe_info& like,
                  const std::function<void(const pld_recipe_info& info, const pld_recipe& recipe)>& found);
std::string nameOf(const pld_recipe_info& info);

}  // namespace pellucid::test
