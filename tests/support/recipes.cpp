#include "tests/support/recipes.h"

namespace pellucid::test {
namespace {

// What later passes may ask besides, each alone and all together.
constexpr uint32_t kTold[] = {0, PLD_FEATURE_DEPTHS, PLD_FEATURE_MOTION, PLD_FEATURE_IDENTITY,
                              PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY};

}  // namespace

RecipePointer makeRecipe(pld_recipe_info info, std::string* why) {
  char message[400] = {};
  info.message = message;
  info.message_size = sizeof(message);
  pld_recipe* made = nullptr;
  const pld_status status = pld_recipe_create(&info, &made);
  if (why) *why = std::string(pld_status_name(status)) + ": " + message;
  return RecipePointer(made);
}

RecipePointer makeShadowRecipe(pld_recipe_info info, const pld_shadow_info& maps, std::string* why) {
  char message[400] = {};
  info.message = message;
  info.message_size = sizeof(message);
  pld_recipe* made = nullptr;
  const pld_status status = pld_shadow_recipe_create(&info, &maps, &made);
  if (why) *why = std::string(pld_status_name(status)) + ": " + message;
  return RecipePointer(made);
}

pld_recipe_info recipeInfoLike(const pld_create_info& create, int version) {
  pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_GL, version);
  info.method = create.method;
  info.tier = create.tier;
  info.features = create.features;
  info.weight = create.weight;
  info.depth = create.depth;
  info.clip = create.clip;
  info.rows = create.rows;
  info.uniform_binding = create.uniform_binding;
  info.texture_binding = create.texture_unit;
  info.storage_binding = create.storage_binding;
  return info;
}

int forEachRecipe(const pld_recipe_info& like,
                  const std::function<void(const pld_recipe_info& info, const pld_recipe& recipe)>& found) {
  int count = 0;
  for (int method = PLD_METHOD_PHENOMENOLOGICAL; method <= PLD_METHOD_OVER; ++method)
    for (int tier = PLD_TIER_FLOAT; tier <= PLD_TIER_EXACT; ++tier)
      for (uint32_t features = 0; features < 2u * PLD_FEATURE_OUTPUTS; ++features)
        for (const uint32_t told : kTold) {
          pld_recipe_info info = like;
          info.method = static_cast<pld_method>(method);
          info.tier = static_cast<pld_tier>(tier);
          info.features = features | told;
          info.depth = PLD_DEPTH_REVERSED;
          const RecipePointer recipe = makeRecipe(info);
          if (!recipe) continue;
          found(info, *recipe);
          ++count;
        }
  return count;
}

std::string nameOf(const pld_recipe_info& info) {
  return "method " + std::to_string(info.method) + ", tier " + std::to_string(info.tier) + ", features " +
         std::to_string(info.features);
}

}  // namespace pellucid::test
