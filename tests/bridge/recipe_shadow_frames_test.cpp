// The GL pass and a host that runs the recipe of shadow maps by a loop of its own give the same bits: of the maps, of
// the table of lookups, and of a frame whose layers ask them.
#include <gtest/gtest.h>

#include "tests/bridge/recipe_host.h"
#include "tests/bridge/shadow_casters.h"
#include "tests/support/recipes.h"

namespace pellucid::test {
namespace {

constexpr int kSize = 64, kLights = 2, kFaces = 7;

pld_create_info createInfo(const Host& host) {
  pld_create_info create = host.info();
  create.features = PLD_FEATURE_COLOURED;
  return create;
}

// Casters with gaps, one after the other.
const char* const kCasters = R"(
uniform int turn;
void main() {
  vec2 p = gl_FragCoord.xy;
  float turns = float(turn);
  if (mod(p.x + 5.0 * turns, 13.0) < 3.0) discard;
  PldCaster caster;
  caster.coverage = 0.3 + 0.01 * p.x;
  caster.transmission = vec3(0.25, 0.5, 0.75) * (0.4 + 0.2 * turns);
  caster.position = vec3(0.02 * (p - 32.0), -(1.2 + 0.4 * turns + 0.01 * p.y));
  caster.normal = normalize(vec3(0.2, 0.1 * turns, 1.0));
  caster.eta = 1.0 / 1.2;
  caster.identity = pldCasterIdentity(uint(turn), uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)";
// Layers that both lights shine on.
const char* const kLayers = R"(
uniform int turn;
void main() {
  vec2 p = gl_FragCoord.xy;
  float turns = float(turn);
  vec3 position = vec3(0.05 * (p - vec2(20.0, 14.0)), -(1.5 + 0.7 * turns + 0.02 * p.x));
  vec3 light = pldShadow(0, position) + pldShadow(1, position) + pldShadowOnOpaque(1, 0.3 * position);
  pldWriteFragment(pldSurface(0.2 * light, 0.6, vec3(0.2, 0.4, 0.1), position));
}
)";

void drawThree(GLuint program) {
  const GLint turn = glGetUniformLocation(program, "turn");
  for (int i = 0; i < 3; ++i) {
    glUniform1i(turn, i);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

struct Drawn {
  std::vector<float> texels, table, picture;
};

std::vector<float> texelsOf(GLuint maps, const pld_shadow_info& info) {
  const int edge = info.form <= PLD_SHADOW_PUBLISHED ? info.size / 4 : info.size;
  std::vector<float> texels(static_cast<std::size_t>(4 * edge * edge * info.faces * (info.coloured ? 3 : 1)));
  glGetTextureImage(maps, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
  return texels;
}

Drawn drawnByThePass(Host& host, const pld_shadow_info& maps, const std::vector<pld_shadow_view>& all) {
  pld_pass* pass = host.create(createInfo(host));
  EXPECT_EQ(pld_shadow_resize(pass, &maps), PLD_OK) << pld_message(pass);
  const char *caster = nullptr, *lookup = nullptr, *layers = nullptr;
  EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &caster), PLD_OK);
  EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, 450, &lookup), PLD_OK);
  EXPECT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &layers), PLD_OK);
  const std::string version = "#version 450 core\n";
  const GLuint casters = makeProgram(kFullscreenVertex, version + caster + kCasters),
               layer = makeProgram(kFullscreenVertex, version + layers + lookup + kLayers);
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  glBindVertexArray(array);
  for (const pld_shadow_view& view : all) {
    EXPECT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
    glUseProgram(casters);
    drawThree(casters);
    EXPECT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
  }
  Drawn drawn;
  uint64_t texture = 0, buffer = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &texture), PLD_OK);
  EXPECT_EQ(pld_query(pass, PLD_VALUE_SHADOW_BUFFER, &buffer), PLD_OK);
  drawn.texels = texelsOf(static_cast<GLuint>(texture), maps);
  GLint bytes = 0;
  glGetNamedBufferParameteriv(static_cast<GLuint>(buffer), GL_BUFFER_SIZE, &bytes);
  drawn.table.resize(static_cast<std::size_t>(bytes) / sizeof(float));
  glGetNamedBufferSubData(static_cast<GLuint>(buffer), 0, bytes, drawn.table.data());
  glBindTextureUnit(maps.texture_unit, static_cast<GLuint>(texture));
  glBindBufferBase(GL_UNIFORM_BUFFER, maps.uniform_binding, static_cast<GLuint>(buffer));
  const pld_frame frame = host.frame();
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  glUseProgram(layer);
  drawThree(layer);
  EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
  glDeleteVertexArrays(1, &array);
  glDeleteProgram(casters);
  glDeleteProgram(layer);
  drawn.picture = host.finish(pass);
  return drawn;
}

Drawn drawnByTheRecipe(Host& host, const pld_shadow_info& maps, const std::vector<pld_shadow_view>& all,
                       pld_rows rows) {
  const pld_recipe_info info = recipeInfoLike(createInfo(host), 450);
  const RecipePointer shadows = makeShadowRecipe(info, maps), frames = makeRecipe(info);
  EXPECT_TRUE(shadows && frames);
  const char* lookup = nullptr;
  EXPECT_EQ(pld_shadow_recipe_glsl(shadows.get(), &lookup, nullptr), PLD_OK);
  RecipeHost caster(*shadows, host, [](pld_stage) { return std::string(kCasters); });
  Drawn drawn;
  std::size_t bytes = 0;
  EXPECT_EQ(pld_shadow_recipe_table_size(shadows.get(), &bytes), PLD_OK);
  drawn.table.resize(bytes / sizeof(float), 7.0f);
  EXPECT_EQ(pld_shadow_recipe_table(shadows.get(), nullptr, rows, drawn.table.data(), bytes), PLD_OK);
  for (const pld_shadow_view& view : all) {
    char why[300];
    EXPECT_EQ(pld_shadow_recipe_check(shadows.get(), &view, why, sizeof(why)), PLD_OK) << why;
    caster.runFace(view, drawThree);
    EXPECT_EQ(pld_shadow_recipe_table(shadows.get(), &view, rows, drawn.table.data(), bytes), PLD_OK);
  }
  drawn.texels = texelsOf(caster.maps(), maps);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferData(buffer, static_cast<GLsizeiptr>(bytes), drawn.table.data(), GL_STATIC_DRAW);
  RecipeHost layer(*frames, host, [&](pld_stage) { return lookup + std::string(kLayers); });
  glBindTextureUnit(maps.texture_unit, caster.maps());
  glBindBufferBase(GL_UNIFORM_BUFFER, maps.uniform_binding, buffer);
  layer.run(host.frame(), [](pld_stage, GLuint program) { drawThree(program); });
  glDeleteBuffers(1, &buffer);
  drawn.picture = host.picture();
  return drawn;
}

// Of the casters some stand behind what the sun sees, and rows run either way.
TEST(BridgeRecipeShadows, AHostThatRunsThemHasTheBitsOfThePass) {
  GlContext context;
  const GLuint depth = makeTexture(GL_DEPTH_COMPONENT32F, kSize, kSize);
  std::vector<float> opaque;
  for (int i = 0; i < kSize * kSize; ++i) opaque.push_back(i % kSize < kSize / 3 ? 0.2f : 0.9f);
  glTextureSubImage2D(depth, 0, 0, 0, kSize, kSize, GL_DEPTH_COMPONENT, GL_FLOAT, opaque.data());
  std::vector<pld_shadow_view> all = sunAndLampViews();
  all[0].depth_texture = depth;
  for (const pld_shadow_form form : kShadowForms)
    for (const bool coloured : {true, false}) {
      const pld_shadow_info maps = shadowInfo(form, kSize, kLights, kFaces, coloured);
      const pld_rows rows = coloured == (form % 2 == 0) ? PLD_ROWS_DOWN : PLD_ROWS_UP;
      Host host(40, 28);
      glClipControl(rows == PLD_ROWS_DOWN ? GL_UPPER_LEFT : GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
      const Drawn pass = drawnByThePass(host, maps, all), recipe = drawnByTheRecipe(host, maps, all, rows);
      glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
      pld_shadow_info bare = maps;  // a map of which nothing was drawn, for how much there is to compare
      const Drawn lit = drawnByThePass(host, bare, {});
      const std::size_t shadowed = differingWords(lit.picture, pass.picture);
      std::printf("form %d, %s: %zu, %zu and %zu of %zu texels', table's and picture's words differ, %zu shadowed\n",
                  form, coloured ? "coloured" : "grey", differingWords(pass.texels, recipe.texels),
                  differingWords(pass.table, recipe.table), differingWords(pass.picture, recipe.picture),
                  pass.texels.size(), shadowed);
      EXPECT_EQ(differingWords(pass.texels, recipe.texels), 0u);
      EXPECT_EQ(differingWords(pass.table, recipe.table), 0u);
      EXPECT_EQ(differingWords(pass.picture, recipe.picture), 0u);
      EXPECT_GT(shadowed, 500u);
    }
  glDeleteTextures(1, &depth);
}

}  // namespace
}  // namespace pellucid::test
