// Every text of every recipe of shadow maps as a compiler sees it, alone and beside that of layers.
#include <gtest/gtest.h>

#include "tests/support/recipes.h"
#include "tests/vulkan/said_text.h"

namespace pellucid::test {
namespace {

const char* const kCaster = R"(
layout(location = 0) in vec3 lightPosition;
void main() {
  PldCaster caster;
  caster.coverage = 0.5;
  caster.transmission = vec3(0.25, 0.5, 0.75);
  caster.position = lightPosition;
  caster.normal = vec3(0.0, 0.0, 1.0);
  caster.eta = 1.0 / 1.5;
  caster.identity = pldCasterIdentity(7u, uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)";
const char* const kLit = R"(
layout(location = 0) in vec3 scenePosition;
layout(location = 0) out vec4 lit;
void main() { lit = vec4(pldShadow(0, scenePosition) + pldShadowOnOpaque(1, scenePosition), 1.0); }
)";
const char* const kLayer = R"(
layout(location = 0) in vec3 viewPosition;
void main() {
  pldWriteFragment(pldSurface(pldShadow(0, viewPosition), 0.5, vec3(0.9, 0.5, 0.2), viewPosition));
}
)";

// The lookup in a light pass of the host's own.
SaidText litText(const pld_recipe_info& info, const pld_shadow_info& maps, const pld_recipe& recipe) {
  const char* lookup = nullptr;
  std::size_t bytes = 0;
  EXPECT_EQ(pld_shadow_recipe_glsl(&recipe, &lookup, nullptr), PLD_OK);
  EXPECT_EQ(pld_shadow_recipe_table_size(&recipe, &bytes), PLD_OK);
  SaidText said;
  said.where = "lookup";
  said.fragment = versionLine(info.dialect) + lookup + kLit;
  said.set = static_cast<int>(info.set);
  said.block = "PldShadows";
  said.constantsBinding = static_cast<int>(maps.uniform_binding);
  said.constantsSize = static_cast<int>(bytes);
  said.reads["pldShadowMaps"] = {said.set, static_cast<int>(maps.texture_unit)};
  said.outputs = {0};
  return said;
}

// Both texts in one shader: bindings that meet would be refused by the validator.
std::string besideLayers(const pld_recipe_info& info, const pld_recipe& recipe, TextKind kind) {
  const RecipePointer frames = makeRecipe(info);
  const char* lookup = nullptr;
  EXPECT_EQ(pld_shadow_recipe_glsl(&recipe, &lookup, nullptr), PLD_OK);
  for (uint32_t i = 0; i < pld_recipe_pass_count(frames.get()); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(frames.get(), i);
    if (pass.kind != PLD_PASS_DRAWS) continue;
    const SpirvText text = compiledText(versionLine(info.dialect) + pass.fragment + lookup + kLayer, false, kind);
    if (!text.failure.empty()) return std::string(pass.name) + ": " + text.failure;
    if (kind == TextKind::vulkan && text.samplers.count("pldShadowMaps") == 0) return "no lookup";
  }
  return {};
}

void expectAll(pld_dialect dialect, int glsl, TextKind kind) {
  pld_recipe_info info = pld_recipe_info_init(dialect, glsl);
  info.set = dialect == PLD_DIALECT_VULKAN ? 1 : 0;
  info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  int texts = 0;
  for (int form = PLD_SHADOW_VARIANCE; form <= PLD_SHADOW_CORRECTED; ++form)
    for (const int coloured : {0, 1})
      for (const int faces : {2, 96}) {
        pld_shadow_info maps = pld_shadow_info_init(256, faces == 96 ? 16 : 2, faces);
        maps.form = static_cast<pld_shadow_form>(form);
        maps.coloured = coloured;
        maps.uniform_binding = 11;
        maps.texture_unit = 12;
        pld_recipe* made = nullptr;
        ASSERT_EQ(pld_shadow_recipe_create(&info, &maps, &made), PLD_OK);
        const RecipePointer recipe(made);
        const std::string name = "form " + std::to_string(form) + (coloured ? ", coloured: " : ", grey: ");
        for (uint32_t i = 0; i < pld_recipe_pass_count(made); ++i, ++texts) {
          const pld_recipe_pass& pass = *pld_recipe_pass_at(made, i);
          EXPECT_EQ(faultOf(saidOf(pass, pass.name, dialect, "", kCaster), kind), "") << name << pass.name;
        }
        EXPECT_EQ(faultOf(litText(info, maps, *made), kind), "") << name << "lookup";
        EXPECT_EQ(besideLayers(info, *made, kind), "") << name;
        texts += 2;
      }
  std::printf("%d texts of shadow maps compiled\n", texts);
}

TEST(VulkanShadowRecipe, EveryTextIsSpirvThatReadsWhatIsSaid) {
  expectAll(PLD_DIALECT_VULKAN, 450, TextKind::vulkan);
  expectAll(PLD_DIALECT_VULKAN, 460, TextKind::vulkan);
}

TEST(VulkanShadowRecipe, EveryTextIsGlslEs) {
  expectAll(PLD_DIALECT_ES, 320, TextKind::es);
}

}  // namespace
}  // namespace pellucid::test
