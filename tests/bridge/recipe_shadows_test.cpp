// Recipes of shadow maps: consistent for every form, and of one piece with the GL pass.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/bridge/recipe_faults.h"
#include "tests/bridge/shadow_casters.h"
#include "tests/support/recipes.h"

namespace pellucid::test {
namespace {

constexpr int kSize = 64, kLights = 2, kFaces = 7;

uint64_t bytesOf(const pld_recipe& recipe) {
  uint64_t bytes = 0;
  for (uint32_t i = 0; i < pld_recipe_image_count(&recipe); ++i) {
    const pld_recipe_image& image = *pld_recipe_image_at(&recipe, i);
    int32_t size[2];
    EXPECT_EQ(pld_recipe_image_size(&recipe, i, 0, 0, size), PLD_OK);
    bytes += static_cast<uint64_t>(bitsOf(image.format) / 8 * size[0] * size[1]) * image.layers;
  }
  return bytes;
}

// Of the areas and layers that a view's passes draw to.
std::string placeFault(const pld_recipe& recipe, const pld_shadow_view& view, std::set<uint32_t>& layers) {
  for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe, i);
    int32_t area[4], size[2], layer = -1;
    if (pld_shadow_recipe_fill(&recipe, i, &view, nullptr, 0, area, &layer) != PLD_OK) return "is not filled";
    for (uint32_t k = 0; k < pass.attachment_count; ++k) {
      const pld_recipe_attachment& one = pass.attachments[k];
      pld_recipe_image_size(&recipe, one.image, 0, 0, size);
      if (area[0] != 0 || area[1] != 0 || area[2] != size[0] || area[3] != size[1]) return "draws to a part";
      if (one.layer != PLD_LAYER_OF_FACE) continue;
      const uint32_t place = static_cast<uint32_t>(layer) + one.location;
      if (place >= pld_recipe_image_at(&recipe, one.image)->layers) return "a layer that there is not";
      if (!layers.insert(place).second) return "a layer twice";
    }
  }
  return {};
}

TEST(BridgeRecipeShadows, EveryFormIsConsistent) {
  pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
  for (const pld_shadow_form form : kShadowForms)
    for (const bool coloured : {true, false}) {
      pld_shadow_info maps = shadowInfo(form, kSize, kLights, kFaces, coloured);
      const RecipePointer recipe = makeShadowRecipe(info, maps);
      ASSERT_TRUE(recipe);
      const std::string name = "form " + std::to_string(form) + (coloured ? ", coloured" : ", grey");
      std::set<uint32_t> written;
      for (uint32_t i = 0; i < pld_recipe_image_count(recipe.get()); ++i) {
        const pld_recipe_image& image = *pld_recipe_image_at(recipe.get(), i);
        EXPECT_NE(image.usage, 0u) << image.name;
        if (image.role == PLD_ROLE_SHADOW_DEPTH) written.insert(i);
        if (image.role != PLD_ROLE_SHADOW_MAPS) continue;
        EXPECT_EQ(image.usage, static_cast<uint32_t>(PLD_USAGE_COLOUR | PLD_USAGE_READ));
        EXPECT_EQ(image.layers, static_cast<uint32_t>(kFaces * (coloured ? 3 : 1)));
      }
      for (uint32_t i = 0; i < pld_recipe_pass_count(recipe.get()); ++i) {
        const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe.get(), i);
        EXPECT_EQ(pass.stage, PLD_STAGE_CASTERS);
        EXPECT_EQ(faultOf(*recipe, pass, written), "") << name << ": " << pass.name;
      }
      EXPECT_EQ(written.size(), pld_recipe_image_count(recipe.get())) << name;
      uint64_t bytes = 0, planes = 0;
      EXPECT_EQ(pld_recipe_query(recipe.get(), PLD_VALUE_SHADOW_BYTES, &bytes), PLD_OK);
      EXPECT_EQ(bytes, bytesOf(*recipe)) << name;
      EXPECT_EQ(pld_recipe_query(recipe.get(), PLD_VALUE_PLANES, &planes), PLD_ERROR_ARGUMENT);
      std::set<uint32_t> layers;
      for (const pld_shadow_view& view : sunAndLampViews()) EXPECT_EQ(placeFault(*recipe, view, layers), "") << name;
      EXPECT_EQ(layers.size(), static_cast<std::size_t>(kFaces * (coloured ? 3 : 1))) << name;
    }
}

TEST(BridgeRecipeShadows, TheGlPassIsOfOnePieceWithThem) {
  GlContext context;
  Host host(16, 16);
  pld_create_info create = host.info();
  create.features = PLD_FEATURE_COLOURED;
  pld_pass* pass = host.create(create);
  ASSERT_NE(pass, nullptr);
  for (const pld_shadow_form form : kShadowForms)
    for (const bool coloured : {true, false}) {
      const pld_shadow_info maps = shadowInfo(form, kSize, kLights, kFaces, coloured);
      ASSERT_EQ(pld_shadow_resize(pass, &maps), PLD_OK) << pld_message(pass);
      for (const int version : {330, 400, 410, 420, 430, 440, 450, 460}) {
        const RecipePointer recipe = makeShadowRecipe(recipeInfoLike(create, version), maps);
        ASSERT_TRUE(recipe);
        const char *caster = nullptr, *lookup = nullptr, *said = nullptr;
        ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, version, &caster), PLD_OK);
        ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, version, &lookup), PLD_OK);
        EXPECT_STREQ(pld_recipe_pass_at(recipe.get(), 0)->fragment, caster);
        ASSERT_EQ(pld_shadow_recipe_glsl(recipe.get(), &said, nullptr), PLD_OK);
        EXPECT_STREQ(said, lookup);
        uint64_t ours = 0, theirs = 0;
        ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_BYTES, &theirs), PLD_OK);
        ASSERT_EQ(pld_recipe_query(recipe.get(), PLD_VALUE_SHADOW_BYTES, &ours), PLD_OK);
        EXPECT_EQ(ours, theirs);
        for (uint32_t i = 1; version <= 450 && i < pld_recipe_pass_count(recipe.get()); ++i) {
          const pld_recipe_pass& one = *pld_recipe_pass_at(recipe.get(), i);
          const GLuint program = makeProgram(one.vertex, one.fragment);
          EXPECT_NE(program, 0u) << one.name << " of GLSL " << version;
          glDeleteProgram(program);
        }
      }
    }
  pld_destroy(&pass);
}

std::string refusal(const pld_recipe_info& info, const pld_shadow_info& maps) {
  std::string why;
  EXPECT_FALSE(makeShadowRecipe(info, maps, &why));
  return why;
}

TEST(BridgeRecipeShadows, WhatCannotBeIsRefusedWithASentence) {
  const pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
  const pld_shadow_info good = shadowInfo(PLD_SHADOW_VARIANCE, kSize, kLights, kFaces, true);
  const auto says = [&](auto change, const char* what) {
    pld_shadow_info maps = good;
    change(maps);
    EXPECT_NE(refusal(info, maps).find(what), std::string::npos) << refusal(info, maps);
  };
  says([](auto& m) { m.struct_size = 4; }, "PLD_ERROR_VERSION: pld_shadow_recipe_create: info.struct_size");
  says([](auto& m) { m.form = static_cast<pld_shadow_form>(5); }, "form 5");
  says([](auto& m) { m.size = 66; }, "PLD_ERROR_SIZE: pld_shadow_recipe_create: size: found 66");
  says([](auto& m) { m.lights = 17; }, "lights: found 17");
  says([](auto& m) { m.faces = 0; }, "faces: found 0");
  says([](auto& m) { m.uniform_binding = 0; }, "expected others");  // the layers' block
  says([](auto& m) { m.texture_unit = 3; }, "expected others");     // one of the layers' textures
  says([](auto& m) { m.texture_unit = m.uniform_binding; }, "expected others");
  says([](auto& m) { m.texture_unit = 1u << 21; }, "above");
  pld_recipe_info wrong = info;
  wrong.glsl = 440;
  EXPECT_NE(refusal(wrong, good).find("PLD_DIALECT_VULKAN with 450"), std::string::npos);
  pld_recipe* made = nullptr;
  EXPECT_EQ(pld_shadow_recipe_create(&info, nullptr, &made), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_create(nullptr, &good, &made), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_create(&info, &good, nullptr), PLD_ERROR_ARGUMENT);
}

// Views that pld_shadow_begin() refuses, and functions of the other kind of recipe.
TEST(BridgeRecipeShadows, WrongCallsAreRefused) {
  const pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
  const pld_shadow_info good = shadowInfo(PLD_SHADOW_VARIANCE, kSize, kLights, kFaces, true);
  const RecipePointer shadows = makeShadowRecipe(info, good), frames = makeRecipe(info);
  ASSERT_TRUE(shadows && frames);
  char why[300];
  pld_shadow_view view = plainShadowView();
  view.light = kLights;
  EXPECT_EQ(pld_shadow_recipe_check(shadows.get(), &view, why, sizeof(why)), PLD_ERROR_ARGUMENT);
  EXPECT_STREQ(why, "pld_shadow_recipe_check: light: found 2, expected 0 to 1");
  int32_t area[4], layer = 0;
  EXPECT_EQ(pld_shadow_recipe_fill(shadows.get(), 0, &view, nullptr, 0, area, &layer), PLD_ERROR_ARGUMENT);
  view = plainShadowView();
  float block[8];
  std::vector<char> table(kLights * 64 + kFaces * 96);
  EXPECT_EQ(pld_shadow_recipe_check(shadows.get(), &view, nullptr, 0), PLD_OK);
  EXPECT_EQ(pld_shadow_recipe_fill(shadows.get(), 0, &view, block, 31, area, &layer), PLD_ERROR_SIZE);
  EXPECT_EQ(pld_shadow_recipe_fill(shadows.get(), 0, &view, block, 32, area, &layer), PLD_OK);
  EXPECT_EQ(pld_shadow_recipe_fill(shadows.get(), 9, &view, block, 32, area, &layer), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_table(shadows.get(), &view, PLD_ROWS_UP, table.data(), table.size() - 1), PLD_ERROR_SIZE);
  EXPECT_EQ(pld_shadow_recipe_table(shadows.get(), &view, PLD_ROWS_UP, table.data(), table.size()), PLD_OK);
  const pld_frame frame = pld_frame_init();
  uint32_t repeats = 0;
  EXPECT_EQ(pld_recipe_check(shadows.get(), &frame, 8, 8, why, sizeof(why)), PLD_ERROR_ARGUMENT);
  EXPECT_NE(std::string(why).find("has no frames"), std::string::npos);
  EXPECT_EQ(pld_recipe_repeats(shadows.get(), 0, &frame, &repeats), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_recipe_fill(shadows.get(), 0, 0, &frame, 8, nullptr, 0, area), PLD_ERROR_ARGUMENT);
  std::size_t bytes = 0;
  const char* text = nullptr;
  EXPECT_EQ(pld_shadow_recipe_table_size(frames.get(), &bytes), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_glsl(frames.get(), &text, nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_fill(frames.get(), 0, &view, block, 32, area, &layer), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_shadow_recipe_check(frames.get(), &view, why, sizeof(why)), PLD_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace pellucid::test
