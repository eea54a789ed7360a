// Recipes: consistent for every permutation, the same for every thread, and of one piece with what the GL pass does.
#include "engine_bridge/include/pellucid/recipe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <vector>

#include "tests/bridge/host.h"
#include "tests/bridge/recipe_faults.h"
#include "tests/support/recipes.h"
// After epoxy, which declares the same.
#include "engine_bridge/c/plan_words.h"
#include "engine_bridge/c/recipe_plan.h"
#include "engine_bridge/c/word_template.h"
#include "engine_bridge/gl/plane_formats.h"

namespace pellucid::test {
namespace {

pld_recipe_info vulkan() {
  pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
  info.set = 1;
  return info;
}

std::string wholeFault(const pld_recipe& recipe) {
  std::set<uint32_t> written;
  for (uint32_t i = 0; i < pld_recipe_image_count(&recipe); ++i) {
    const pld_role role = pld_recipe_image_at(&recipe, i)->role;
    if (role == PLD_ROLE_COLOUR || role == PLD_ROLE_DEPTH || role == PLD_ROLE_OCCLUSION) written.insert(i);
  }
  uint64_t bits = 0, planes = 0, draws = 0;
  for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe, i);
    if (const std::string fault = faultOf(recipe, pass, written); !fault.empty())
      return std::string(pass.name) + ": " + fault;
    const bool layers = pass.stage == PLD_STAGE_LAYERS &&
                        (std::strcmp(pass.name, "layers") == 0 || std::strcmp(pass.name, "layers folded") == 0);
    draws += pass.kind == PLD_PASS_DRAWS && pass.stage != PLD_STAGE_LOW;
    for (uint32_t k = 0; layers && k < pass.attachment_count; ++k, ++planes)
      bits += static_cast<uint64_t>(bitsOf(pld_recipe_image_at(&recipe, pass.attachments[k].image)->format));
  }
  for (uint32_t i = 0; i < pld_recipe_image_count(&recipe); ++i) {
    const pld_recipe_image& image = *pld_recipe_image_at(&recipe, i);
    if (image.usage == 0) return std::string("nobody uses ") + image.name;
    if (image.role == PLD_ROLE_PICTURE && !written.count(i)) return "no picture";
  }
  uint64_t said[3] = {};
  pld_recipe_query(&recipe, PLD_VALUE_BITS_PER_PIXEL, &said[0]);
  pld_recipe_query(&recipe, PLD_VALUE_PLANES, &said[1]);
  pld_recipe_query(&recipe, PLD_VALUE_GEOMETRY_PASSES, &said[2]);
  if (said[0] != bits || said[1] != planes || said[2] != draws) return "other bits, planes or draws than it says";
  return {};
}

TEST(BridgeRecipe, EveryPermutationIsConsistent) {
  std::set<std::string> wrong;
  std::set<uint64_t> texts;
  const int count = forEachRecipe(vulkan(), [&](const pld_recipe_info& info, const pld_recipe& recipe) {
    if (const std::string fault = wholeFault(recipe); !fault.empty()) wrong.insert(fault + " (" + nameOf(info) + ")");
    for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) texts.insert(pld_recipe_pass_at(&recipe, i)->hash);
  });
  std::printf("%d permutations, %zu texts\n", count, texts.size());
  EXPECT_EQ(count, 7272);
  for (const std::string& sentence : wrong) ADD_FAILURE() << sentence;
}

// The check above is checked: a pass whose input nobody wrote, and one that reads what it writes.
TEST(BridgeRecipe, PlantedFaultsAreFound) {
  pld_recipe_info info = vulkan();
  info.features = PLD_FEATURE_DIFFUSION;
  const RecipePointer recipe = makeRecipe(info);
  ASSERT_TRUE(recipe);
  const uint32_t last = pld_recipe_pass_count(recipe.get()) - 1;
  std::set<uint32_t> nothing, all;
  for (uint32_t i = 0; i < pld_recipe_image_count(recipe.get()); ++i) all.insert(i);
  pld_recipe_pass pass = *pld_recipe_pass_at(recipe.get(), last);
  EXPECT_EQ(faultOf(*recipe, pass, all), "");
  EXPECT_NE(faultOf(*recipe, pass, nothing), "");
  pld_recipe_attachment wrong = pass.attachments[0];
  wrong.image = pass.reads[1].image;
  pass.attachments = &wrong;
  EXPECT_NE(faultOf(*recipe, pass, all).find("reads what it writes"), std::string::npos);
}

TEST(BridgeRecipe, EightThreadsMakeTheSame) {
  const auto hashes = [] {
    std::vector<uint64_t> all;
    pld_recipe_info info = vulkan();
    for (const uint32_t features : {0u, 511u, 47u, 255u}) {
      info.features = features;
      const RecipePointer recipe = makeRecipe(info);
      for (uint32_t i = 0; recipe && i < pld_recipe_pass_count(recipe.get()); ++i)
        all.push_back(pld_recipe_pass_at(recipe.get(), i)->hash);
    }
    return all;
  };
  // First, so that what recipes share is made by all threads at once.
  std::array<std::vector<uint64_t>, 8> together;
  std::vector<std::thread> threads;
  for (std::vector<uint64_t>& one : together) threads.emplace_back([&one, &hashes] { one = hashes(); });
  for (std::thread& thread : threads) thread.join();
  const std::vector<uint64_t> alone = hashes();
  EXPECT_GT(alone.size(), 25u);
  for (const std::vector<uint64_t>& one : together) EXPECT_EQ(one, alone);
}

TEST(BridgeRecipe, ATextThatIsReadOnceIsWrittenLikeOneThatIsReadEachTime) {
  const std::string text = "layout(binding = 3) precise float binding;  // a binding\nfloat x = binding * 0x1f;\n";
  const c::WordTemplate once(text, [](std::string_view word) { return word == "binding" || word == "precise"; });
  for (const std::string set : {"", "set = 0, ", "set = 12, "}) {
    const auto change = [&](std::string_view word, std::string& out) {
      if (word == "binding") out += set;
      if (word != "precise" || set.empty()) out += word;
    };
    std::string written = "before ";
    once.write(written, change);
    EXPECT_EQ(written, "before " + c::withWords(text, change));
    EXPECT_EQ(written.find("12, binding * 0x1f") != std::string::npos, set.size() > 9) << written;
  }
}

std::string refusal(const pld_recipe_info& info) {
  std::string why;
  EXPECT_FALSE(makeRecipe(info, &why));
  return why;
}

TEST(BridgeRecipe, WhatCannotBeIsRefusedWithASentence) {
  pld_recipe_info info = vulkan();
  info.method = PLD_METHOD_WEIGHTED;
  info.features = PLD_FEATURE_REFRACTION;
  EXPECT_NE(refusal(info).find("PLD_ERROR_UNSUPPORTED: pld_recipe_create: features: found refraction"),
            std::string::npos)
      << refusal(info);
  info = vulkan();
  info.tier = PLD_TIER_EXACT;
  info.dialect = PLD_DIALECT_ES;
  info.glsl = 320;
  EXPECT_NE(refusal(info).find("PLD_ERROR_UNSUPPORTED: pld_recipe_create: PLD_TIER_EXACT"), std::string::npos);
  info.dialect = PLD_DIALECT_GL;
  info.glsl = 420;
  EXPECT_NE(refusal(info).find("PLD_TIER_EXACT"), std::string::npos);
  info = vulkan();
  info.glsl = 440;
  EXPECT_NE(refusal(info).find("PLD_DIALECT_VULKAN with 450 or 460"), std::string::npos);
  info = vulkan();
  info.uniform_binding = info.texture_binding + 2;
  EXPECT_NE(refusal(info).find("meet"), std::string::npos);
  info = vulkan();
  info.weight = static_cast<pld_weight>(1000);
  EXPECT_NE(refusal(info).find("weight: found 1000"), std::string::npos);
  info = vulkan();
  info.features = 4096;
  EXPECT_NE(refusal(info).find("features"), std::string::npos);
  info = vulkan();
  info.version = PLD_VERSION + (1u << 20);
  EXPECT_NE(refusal(info).find("PLD_ERROR_VERSION"), std::string::npos);
  info = vulkan();
  info.struct_size -= 8;
  EXPECT_NE(refusal(info).find("PLD_ERROR_VERSION"), std::string::npos);
  info = vulkan();
  pld_frame fixed = pld_frame_init();
  fixed.metres_per_unit = -1.0f;
  info.fixed = &fixed;
  info.fixed_fields = PLD_FIXED_UNITS;
  EXPECT_NE(refusal(info).find("metres_per_unit"), std::string::npos);
  info.fixed = nullptr;
  EXPECT_NE(refusal(info).find("fixed is null"), std::string::npos);
  EXPECT_EQ(pld_recipe_create(nullptr, nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_recipe_pass_count(nullptr), 0u);
  EXPECT_EQ(pld_recipe_pass_at(nullptr, 0), nullptr);
}

// A frame of the test's host, without textures.
pld_frame frameOf(int width, int height) {
  pld_frame frame = pld_frame_init();
  frame.width = width;
  frame.height = height;
  frame.projection[0] = 1.5f;
  frame.projection[5] = 2.0f;
  frame.projection[10] = frame.projection[11] = -1.0f;
  frame.projection[14] = -0.2f;
  return frame;
}

TEST(BridgeRecipe, FramesAreCheckedAndFilled) {
  pld_recipe_info info = vulkan();
  info.features = 511;
  const RecipePointer recipe = makeRecipe(info);
  ASSERT_TRUE(recipe);
  pld_frame frame = frameOf(64, 48);
  char why[300];
  EXPECT_EQ(pld_recipe_check(recipe.get(), &frame, 64, 48, why, sizeof(why)), PLD_OK) << why;
  EXPECT_EQ(pld_recipe_check(recipe.get(), &frame, 32, 48, why, sizeof(why)), PLD_ERROR_SIZE);
  frame.low_factor = 3;
  EXPECT_EQ(pld_recipe_check(recipe.get(), &frame, 64, 48, why, sizeof(why)), PLD_ERROR_ARGUMENT);
  EXPECT_NE(std::string(why).find("low_factor"), std::string::npos);
  frame.low_factor = 4;
  frame.weight_near = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pld_recipe_check(recipe.get(), &frame, 64, 48, nullptr, 0), PLD_ERROR_ARGUMENT);
  frame.weight_near = 0.1f;
  std::map<std::string, std::array<int32_t, 4>> areas;
  for (uint32_t i = 0; i < pld_recipe_pass_count(recipe.get()); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe.get(), i);
    uint32_t repeats = 0;
    ASSERT_EQ(pld_recipe_repeats(recipe.get(), i, &frame, &repeats), PLD_OK);
    std::vector<char> constants(pass.constants_size);
    std::array<int32_t, 4> area{};
    ASSERT_GE(repeats, 1u) << pass.name;
    EXPECT_EQ(pld_recipe_fill(recipe.get(), i, 0, &frame, 64, constants.data(), constants.size(), area.data()), PLD_OK);
    EXPECT_EQ(pld_recipe_fill(recipe.get(), i, repeats, &frame, 64, nullptr, 0, area.data()), PLD_ERROR_ARGUMENT);
    EXPECT_EQ(pld_recipe_fill(recipe.get(), i, 0, &frame, 63, nullptr, 0, area.data()), PLD_ERROR_SIZE);
    if (pass.constants_size > 0) {
      EXPECT_EQ(pld_recipe_fill(recipe.get(), i, 0, &frame, 64, constants.data(), 1, area.data()), PLD_ERROR_SIZE);
    }
    areas[pass.name] = area;
  }
  EXPECT_EQ(areas["layers"], (std::array<int32_t, 4>{0, 0, 64, 48}));
  EXPECT_EQ(areas["low resolution"], (std::array<int32_t, 4>{0, 0, 16, 12}));
  EXPECT_EQ(areas["low resolution upsampled"], (std::array<int32_t, 4>{0, 0, 64, 48}));
  EXPECT_EQ(areas["spread"], (std::array<int32_t, 4>{0, 0, 36, 28})) << "half of the picture and a margin of two";
}

// Levels of the pyramid fit their layers, and none lies in another.
TEST(BridgeRecipe, LevelsOfThePyramidLieApart) {
  pld_recipe_info info = vulkan();
  info.features = PLD_FEATURE_DIFFUSION;
  const RecipePointer recipe = makeRecipe(info);
  ASSERT_TRUE(recipe);
  const pld_frame frame = frameOf(1917, 1083);
  for (uint32_t pass = 0; pass < pld_recipe_pass_count(recipe.get()); ++pass) {
    const pld_recipe_pass& one = *pld_recipe_pass_at(recipe.get(), pass);
    if (std::strcmp(one.name, "spread") != 0) continue;
    int32_t size[2], rows[2] = {}, area[4];
    ASSERT_EQ(pld_recipe_image_size(recipe.get(), one.attachments[0].image, 1920, 1088, size), PLD_OK);
    uint32_t repeats = 0;
    ASSERT_EQ(pld_recipe_repeats(recipe.get(), pass, &frame, &repeats), PLD_OK);
    EXPECT_GT(repeats, 8u);
    for (uint32_t repeat = 0; repeat < repeats; ++repeat) {
      ASSERT_EQ(pld_recipe_fill(recipe.get(), pass, repeat, &frame, 1920, nullptr, 0, area), PLD_OK);
      EXPECT_EQ(area[1], rows[repeat % 2]);
      rows[repeat % 2] = area[1] + area[3];
      EXPECT_LE(area[2], size[0]);
      EXPECT_LE(rows[repeat % 2], size[1]);
    }
    return;
  }
  FAIL() << "no pass of the pyramid";
}

// Formats and blends go to GL by pld_format and pld_blend in the C library, and straight in the rooms: by the same
// words.
TEST(BridgeRecipe, PlanesHaveTheWordsOfTheRooms) {
  for (int i = 0; i <= static_cast<int>(PlaneFormat::rg8snorm); ++i) {
    const auto format = static_cast<PlaneFormat>(i);
    EXPECT_EQ(c::wordOf(c::formatOf(format)), gl::formatOf(format)) << i;
    EXPECT_EQ(c::bitsOf(c::formatOf(format)), pellucid::bitsOf(format)) << i;
  }
  for (int i = 0; i <= static_cast<int>(PlaneBlend::product); ++i) {
    const gl::BlendWords rooms = gl::blendOf(static_cast<PlaneBlend>(i));
    const pld_blend blend = c::blendOf(static_cast<PlaneBlend>(i));
    EXPECT_EQ(blend.enabled, 1);
    EXPECT_EQ(c::wordOf(blend.source), rooms.source) << i;
    EXPECT_EQ(c::wordOf(blend.destination), rooms.destination) << i;
    EXPECT_EQ(c::wordOf(blend.op), rooms.equation) << i;
    EXPECT_EQ(c::wordOf(blend.alpha_source), static_cast<GLenum>(GL_ONE)) << i;
    EXPECT_EQ(c::wordOf(blend.alpha_destination), static_cast<GLenum>(GL_ONE)) << i;
    EXPECT_EQ(c::wordOf(blend.alpha_op), rooms.alphaEquation) << i;
  }
}

// The GL pass holds the recipe's seams, and as many bits; its textures are the recipe's images.
TEST(BridgeRecipe, TheGlPassIsOfOnePieceWithIt) {
  GlContext context;
  Host host(32, 24);
  const std::pair<pld_tier, uint32_t> kinds[] = {{PLD_TIER_FLOAT, 511u & ~uint32_t{PLD_FEATURE_DIFFUSION}},
                                                 {PLD_TIER_HALF, PLD_FEATURE_COLOURED},
                                                 {PLD_TIER_PUBLISHED, PLD_FEATURE_REFRACTION},
                                                 {PLD_TIER_EXACT, PLD_FEATURE_LIGHT | PLD_FEATURE_SOLIDS},
                                                 {PLD_TIER_HALF, PLD_FEATURE_SOLIDS | PLD_FEATURE_MOTION},
                                                 {PLD_TIER_FLOAT, PLD_FEATURE_IDENTITY},
                                                 {PLD_TIER_EXACT, PLD_FEATURE_SOLIDS | 7u * PLD_FEATURE_DEPTHS}};
  for (const auto& [tier, features] : kinds) {
    pld_create_info create = host.info();
    create.tier = tier;
    create.features = features;
    create.fragments_per_pixel = 4.0f;
    pld_pass* pass = host.create(create);
    ASSERT_NE(pass, nullptr);
    pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_GL, 450);
    info.tier = tier;
    info.features = features;
    info.depth = create.depth;
    info.rows = create.rows;
    info.uniform_binding = create.uniform_binding;
    info.texture_binding = create.texture_unit;
    info.storage_binding = create.storage_binding;
    const RecipePointer recipe = makeRecipe(info);
    ASSERT_TRUE(recipe);
    for (uint32_t i = 0; i < pld_recipe_pass_count(recipe.get()); ++i) {
      const pld_recipe_pass& one = *pld_recipe_pass_at(recipe.get(), i);
      const char* seam = nullptr;
      if (one.kind != PLD_PASS_DRAWS) continue;
      ASSERT_EQ(pld_glsl(pass, one.stage, 450, &seam), PLD_OK);
      EXPECT_STREQ(seam, one.fragment);
    }
    uint64_t bytes = 0, expected = 0;
    for (uint32_t i = 0; i < pld_recipe_image_count(recipe.get()); ++i) {
      const pld_recipe_image& image = *pld_recipe_image_at(recipe.get(), i);
      int32_t size[2];
      ASSERT_EQ(pld_recipe_image_size(recipe.get(), i, host.width, host.height, size), PLD_OK);
      bytes += static_cast<uint64_t>(bitsOf(image.format) / 8 * size[0] * size[1]) * image.layers;
    }
    for (uint32_t i = 0; i < pld_recipe_buffer_count(recipe.get()); ++i) {
      uint64_t one = 0;
      ASSERT_EQ(pld_recipe_buffer_size(recipe.get(), i, host.width, host.height,
                                       static_cast<uint64_t>(4 * host.width * host.height), &one, nullptr),
                PLD_OK);
      bytes += one;
    }
    ASSERT_EQ(pld_query(pass, PLD_VALUE_BYTES, &expected), PLD_OK);
    EXPECT_EQ(bytes, expected) << "tier " << tier;
    for (const pld_value value : {PLD_VALUE_BITS_PER_PIXEL, PLD_VALUE_PLANES, PLD_VALUE_GEOMETRY_PASSES}) {
      uint64_t ours = 0, theirs = 0;
      ASSERT_EQ(pld_query(pass, value, &theirs), PLD_OK);
      ASSERT_EQ(pld_recipe_query(recipe.get(), value, &ours), PLD_OK);
      EXPECT_EQ(ours, theirs);
    }
    pld_destroy(&pass);
  }
}

}  // namespace
}  // namespace pellucid::test
