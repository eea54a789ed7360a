// The GL pass and a host that runs the recipe by a loop of its own give the same bits, of every stage and tier: loose
// numbers and blocks, a pyramid of one layer and of two, and the two loops are one.
#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "tests/bridge/recipe_host.h"
#include "tests/support/recipes.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 48, kHeight = 32;
constexpr float kNear = 0.1f;

struct Kind {
  pld_method method;
  pld_tier tier;
  uint32_t features;
  pld_depth depth = PLD_DEPTH_LINEAR;
};

// Sheets that bend, spread and let colour through, with gaps; of solids without a hole.
std::string mainOf(pld_stage stage) {
  const std::string coverage = stage == PLD_STAGE_SOLIDS ? "1.0" : "0.6";
  return "uniform int turn;\n"
         "void main() {\n"
         "  vec2 p = gl_FragCoord.xy;\n"
         "  float turns = float(turn), z = -(1.5 + 0.7 * turns + 0.02 * p.x);\n"
         "  if (mod(p.x + 3.0 * turns, 11.0) < 3.0) discard;\n"
         "  PldSurface s = pldSurface(vec3(0.1, 0.2, 0.002 * p.y) * (1.0 + turns), " +
         coverage +
         ", vec3(0.2, 0.4, 0.1) * (1.0 + turns) * 0.4, vec3(p * 0.01, z));\n"
         "  s.normal = normalize(vec3(0.2 * sin(p.x), 0.1, 1.0));\n"
         "  s.eta = 1.0 / 1.4;\n"
         "  s.etaRedBlue = vec2(1.0 / 1.38, 1.0 / 1.43);\n"
         "  s.collimation = 0.7;\n"
         "#ifdef PLD_MARKS\n"
         "  s.motion = vec2(p.x - 20.0, 3.0 * turns);\n"
         "  s.identity = 100u * uint(turn) + uint(p.y);\n"
         "#endif\n" +
         (stage == PLD_STAGE_RIMS ? "  pldWriteRim(s, vec3(0.1, 0.15, 0.2), vec2(0.1, 0.05));\n}\n"
                                  : "  pldWriteFragment(s);\n}\n");
}

void drawSheets(GLuint program) {
  const GLint turn = glGetUniformLocation(program, "turn");
  for (int i = 0; i < 3; ++i) {
    glUniform1i(turn, i);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

// A wall on the right before one further off, of a colour that changes from pixel to pixel.
void fill(Host& host, pld_depth kind) {
  std::vector<float> colour, depth;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) colour.push_back(0.1f + 0.03f * static_cast<float>((7 * x + 13 * y + 5 * c) % 23));
      colour.push_back(1.0f);
      const float z = x > 30 ? 2.5f : 8.0f + 0.01f * static_cast<float>(y);
      depth.push_back(kind == PLD_DEPTH_LINEAR ? z : kNear / z);
    }
  fillTexture(host.colour, kWidth, kHeight, GL_RGBA, colour.data());
  if (kind != PLD_DEPTH_LINEAR) {
    glDeleteTextures(1, &host.depth);
    host.depth = makeTexture(GL_DEPTH_COMPONENT32F, kWidth, kHeight);
  }
  glTextureSubImage2D(host.depth, 0, 0, 0, kWidth, kHeight, kind == PLD_DEPTH_LINEAR ? GL_RED : GL_DEPTH_COMPONENT,
                      GL_FLOAT, depth.data());
}

// Smaller than its textures.
pld_frame frameOf(const Host& host, pld_depth kind) {
  pld_frame frame = host.frame();
  frame.width = kWidth - 6;
  frame.height = kHeight - 4;
  if (kind == PLD_DEPTH_LINEAR) return frame;
  frame.projection[10] = 0.0f;
  frame.projection[14] = kNear;
  return frame;
}

// The roles of recipes that are outputs, and their views.
constexpr std::pair<pld_role, pld_view> kOutputs[] = {
    {PLD_ROLE_REACTIVE, PLD_VIEW_REACTIVE},     {PLD_ROLE_NEAREST_DEPTH, PLD_VIEW_NEAREST_DEPTH},
    {PLD_ROLE_MEAN_DEPTH, PLD_VIEW_MEAN_DEPTH}, {PLD_ROLE_OPACITY_DEPTH, PLD_VIEW_OPACITY_DEPTH},
    {PLD_ROLE_MOTION, PLD_VIEW_MOTION},         {PLD_ROLE_IDENTITY, PLD_VIEW_IDENTITY}};

bool has(const pld_recipe& recipe, pld_role role) {
  for (uint32_t i = 0; i < pld_recipe_image_count(&recipe); ++i)
    if (pld_recipe_image_at(&recipe, i)->role == role) return true;
  return false;
}

//   outputs  by role, of those that the recipe has
std::vector<float> drawnByThePass(Host& host, const Kind& kind, const pld_recipe& recipe,
                                  std::map<pld_role, std::vector<float>>& outputs) {
  pld_create_info info = host.info();
  info.method = kind.method;
  info.tier = kind.tier;
  info.features = kind.features;
  info.depth = kind.depth;
  info.clip = PLD_CLIP_ZERO_TO_ONE;
  info.fragments_per_pixel = 8.0f;
  const pld_frame frame = frameOf(host, kind.depth);
  pld_pass* pass = host.create(info);
  if (!pass) return {};
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) {
    const pld_recipe_pass& one = *pld_recipe_pass_at(&recipe, i);
    if (one.kind != PLD_PASS_DRAWS) continue;
    const char* seam = nullptr;
    EXPECT_EQ(pld_glsl(pass, one.stage, 450, &seam), PLD_OK) << pld_message(pass);
    const GLuint program =
        makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + mainOf(one.stage));
    EXPECT_EQ(pld_begin(pass, one.stage, &frame), PLD_OK) << pld_message(pass);
    glUseProgram(program);
    glBindVertexArray(array);
    drawSheets(program);
    EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    glDeleteProgram(program);
  }
  glDeleteVertexArrays(1, &array);
  for (const auto& [role, view] : kOutputs) {
    pld_target target = host.target();
    target.view = view;
    EXPECT_EQ(pld_resolve(pass, &target) == PLD_OK, has(recipe, role)) << pld_message(pass);
    if (has(recipe, role)) outputs[role] = host.picture();
  }
  return host.finish(pass);
}

int changedPixels(const Host& host, const pld_frame& frame, const std::vector<float>& picture) {
  const std::vector<float> background = readTexture(host.colour, kWidth, kHeight, GL_RGBA);
  int changed = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto red = static_cast<std::size_t>(4 * (y * kWidth + x));
      changed += picture[red] != background[red];
    }
  return changed;
}

// Outside of it the recipe's images hold nothing yet.
std::size_t differingInFrame(const pld_frame& frame, const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<float> inA, inB;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const auto pixel = static_cast<int>(i / 4);
    if (pixel % kWidth >= frame.width || pixel / kWidth >= frame.height) continue;
    inA.push_back(a[i]);
    inB.push_back(b[i]);
  }
  return differingWords(inA, inB);
}

TEST(BridgeRecipeFrames, AHostThatRunsTheRecipeHasTheBitsOfThePass) {
  constexpr uint32_t colours = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT;
  constexpr uint32_t scatters = PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION | PLD_FEATURE_DISPERSION;
  constexpr uint32_t parts = PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
  constexpr uint32_t told = PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;
  const Kind kinds[] = {
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, colours | scatters | parts | PLD_FEATURE_OUTPUTS},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, colours | scatters | PLD_FEATURE_SOLIDS, PLD_DEPTH_REVERSED},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_HALF, colours | parts, PLD_DEPTH_REVERSED},
      {PLD_METHOD_WEIGHTED, PLD_TIER_HALF, PLD_FEATURE_RIMS},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT, colours | scatters | parts},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, PLD_FEATURE_SOLIDS, PLD_DEPTH_REVERSED},
      {PLD_METHOD_OVER, PLD_TIER_EXACT, PLD_FEATURE_SOLIDS | PLD_FEATURE_OUTPUTS},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT,
       PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION | parts | told},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_HALF, PLD_FEATURE_SOLIDS | told, PLD_DEPTH_REVERSED},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT, colours | scatters | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | told},
      {PLD_METHOD_OVER, PLD_TIER_EXACT, told, PLD_DEPTH_REVERSED}};
  GlContext context;
  for (const Kind& kind : kinds) {
    pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_GL, 450);
    info.method = kind.method;
    info.tier = kind.tier;
    info.features = kind.features;
    info.depth = kind.depth;
    info.clip = PLD_CLIP_ZERO_TO_ONE;
    info.rows = PLD_ROWS_DOWN;
    info.texture_binding = 1;
    info.storage_binding = 5;
    std::string why;
    const RecipePointer recipe = makeRecipe(info, &why);
    ASSERT_TRUE(recipe) << why;
    Host host(kWidth, kHeight);
    fill(host, kind.depth);
    std::map<pld_role, std::vector<float>> outputs;
    const std::vector<float> empty = host.picture(), expected = drawnByThePass(host, kind, *recipe, outputs);
    ASSERT_EQ(expected.size(), empty.size()) << nameOf(info);
    EXPECT_GT(changedPixels(host, frameOf(host, kind.depth), expected), 500) << nameOf(info);
    fillTexture(host.output, kWidth, kHeight, GL_RGBA, empty.data());
    RecipeHost runner(*recipe, host, mainOf);
    runner.run(frameOf(host, kind.depth), [](pld_stage, GLuint program) { drawSheets(program); });
    const std::vector<float> picture = host.picture();
    std::size_t differing = differingWords(picture, expected);
    for (const auto& [role, output] : outputs)
      differing += differingInFrame(frameOf(host, kind.depth), output, runner.output(role));
    std::printf("%s, depth %d: %zu of %zu words differ\n", nameOf(info).c_str(), static_cast<int>(kind.depth),
                differing, picture.size());
    EXPECT_EQ(differing, 0u);
  }
}

}  // namespace
}  // namespace pellucid::test
