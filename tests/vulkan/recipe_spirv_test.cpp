// Every text of every recipe as a compiler sees it: SPIR-V that the validator takes, which reads what the recipe says
// it reads, and GLSL ES.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/recipes.h"
#include "tests/vulkan/said_text.h"

namespace pellucid::test {
namespace {

// A host's shader behind the seam.
const char* const kHost = R"(
layout(location = 0) in vec3 viewPosition;
void main() {
  PldSurface surface = pldSurface(vec3(0.2), 0.5, vec3(0.9, 0.5, 0.2), viewPosition);
  surface.normal = normalize(-viewPosition);
  surface.eta = 1.0 / 1.5;
  surface.collimation = 0.5;
#ifdef HAS_RIMS
  pldWriteRim(surface, vec3(0.1), pldCoverageGradient(surface.coverage));
#else
  pldWriteFragment(surface);
#endif
}
)";

SaidText saidBy(const pld_recipe_info& info, const pld_recipe_pass& pass) {
  const std::string where = std::string(pass.name) + " (" + nameOf(info) + ")";
  return saidOf(pass, where, info.dialect, info.features & PLD_FEATURE_RIMS ? "#define HAS_RIMS\n" : "", kHost);
}

// The texts of all permutations, each once for all that recipes say of it.
std::vector<SaidText> everyText(pld_dialect dialect, int glsl, int& permutations) {
  pld_recipe_info like = pld_recipe_info_init(dialect, glsl);
  if (dialect == PLD_DIALECT_VULKAN) like.set = 1;
  std::set<std::string> seen;
  std::vector<SaidText> texts;
  permutations = forEachRecipe(like, [&](const pld_recipe_info& info, const pld_recipe& recipe) {
    for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) {
      const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe, i);
      SaidText said = saidBy(info, pass);
      std::string key = std::to_string(pass.hash);
      for (const auto& [name, place] : said.reads) key += name + std::to_string(place.second);
      for (const auto& [name, place] : said.storage) key += name;
      for (const int output : said.outputs) key += std::to_string(output);
      if (seen.insert(key).second) texts.push_back(std::move(said));
    }
  });
  return texts;
}

void expectAll(const std::vector<SaidText>& texts, TextKind kind) {
  std::atomic<std::size_t> next{0};
  std::mutex speaking;
  std::vector<std::thread> threads;
  const unsigned count = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < count; ++i)
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < texts.size(); at = next++) {
        const std::string fault = faultOf(texts[at], kind);
        if (fault.empty()) continue;
        const std::lock_guard<std::mutex> lock(speaking);
        ADD_FAILURE() << texts[at].where << ": " << fault;
      }
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(VulkanRecipe, EveryTextIsSpirvThatReadsWhatIsSaid) {
  int permutations = 0;
  const std::vector<SaidText> texts = everyText(PLD_DIALECT_VULKAN, 450, permutations);
  std::printf("%d permutations, %zu texts to SPIR-V\n", permutations, texts.size());
  EXPECT_EQ(permutations, 7272);
  EXPECT_GT(texts.size(), 1000u);
  expectAll(texts, TextKind::vulkan);
}

// All tiers but the exact one, which has no ES.
TEST(VulkanRecipe, EveryTextIsGlslEs) {
  int permutations = 0;
  const std::vector<SaidText> texts = everyText(PLD_DIALECT_ES, 320, permutations);
  std::printf("%d permutations, %zu texts as GLSL ES 3.20\n", permutations, texts.size());
  EXPECT_GT(texts.size(), 900u);
  expectAll(texts, TextKind::es);
}

// The comparison above finds a texture that is not read, one that nobody told of, and text that is none.
TEST(VulkanRecipe, PlantedFaultsAreFound) {
  SaidText said;
  said.fragment =
      "#version 450\nlayout(set = 0, binding = 1) uniform sampler2D a;\nlayout(location = 0) out vec4 c;\n"
      "void main() { c = texelFetch(a, ivec2(0), 0); }\n";
  said.outputs = {0};
  said.reads["a"] = {0, 1};
  EXPECT_EQ(faultOf(said, TextKind::vulkan), "");
  said.reads["b"] = {0, 2};
  EXPECT_NE(faultOf(said, TextKind::vulkan), "");
  said.reads = {{"a", {0, 2}}};
  EXPECT_NE(faultOf(said, TextKind::vulkan), "");
  said.reads = {{"a", {0, 1}}};
  said.fragment += "float f = undeclared;\n";
  EXPECT_NE(faultOf(said, TextKind::vulkan), "");
}

}  // namespace
}  // namespace pellucid::test
