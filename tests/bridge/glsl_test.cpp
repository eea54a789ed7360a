// The seam as text: it compiles as every GLSL that it is offered for, beside names that a host may have of its own.
#include <gtest/gtest.h>

#include <chrono>

#include <cstdlib>
#include <string>

#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kTold = PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;

// A host's shader with names that the model's text uses too.
const char* const kHostShader = R"(
struct Layer { vec4 layer; };
struct Scatter { float scatter; };
uniform sampler2D background;
uniform vec4 radianceSum;
float meanOf(vec3 v) { return v.x; }
float SCATTER_GREY = 1.0;
float seamOpaqueZ, seamSolidZ, seamFrontZ;
vec2 seamGradient;
in vec3 viewPosition;
void main() {
  Layer layer;
  layer.layer = vec4(meanOf(viewPosition));
  vec3 radiance = radianceSum.rgb + layer.layer.rgb * SCATTER_GREY;
  PldSurface surface = pldSurface(radiance, 0.5, vec3(0.9, 0.5, 0.2), viewPosition);
  surface.normal = normalize(-viewPosition);
  surface.eta = 1.0 / 1.5;
  surface.etaRedBlue = vec2(1.0 / 1.49, 1.0 / 1.51);
  surface.collimation = 0.5;
#ifdef PLD_MARKS
  surface.motion = viewPosition.xy;
  surface.identity = 7u;
#endif
  pldWriteFragment(surface);
}
)";
const char* const kHostVertex = R"(
in vec3 position;
out vec3 viewPosition;
void main() {
  viewPosition = position;
  gl_Position = vec4(position, 1.0);
}
)";

TEST(BridgeGlsl, EveryPermutationCompilesAsEveryVersion) {
  // Mesa's software driver compiles 4.60 when it is told to; another driver does not look at these.
  setenv("MESA_GL_VERSION_OVERRIDE", "4.6", 1);
  setenv("MESA_GLSL_VERSION_OVERRIDE", "460", 1);
  GlContext context;
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  unsetenv("MESA_GLSL_VERSION_OVERRIDE");
  GLint most = 0;
  const char* shading = reinterpret_cast<const char*>(glGetString(GL_SHADING_LANGUAGE_VERSION));
  most = static_cast<GLint>(100 * std::atof(shading) + 0.5);
  Host host(16, 16);
  struct Case {
    pld_method method;
    pld_tier tier;
    uint32_t features;
  };
  constexpr uint32_t all = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                           PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS;
  const Case cases[] = {
      {PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, 0},
      {PLD_METHOD_WEIGHTED, PLD_TIER_HALF, PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, all},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF, all | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION},
      {PLD_METHOD_WEIGHTED, PLD_TIER_FLOAT, PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF, all},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, PLD_FEATURE_DIFFUSION},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, all & ~static_cast<uint32_t>(PLD_FEATURE_LIGHT)},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_HALF, PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, PLD_FEATURE_REFRACTION | PLD_FEATURE_SOLIDS},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, 0},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, PLD_FEATURE_RIMS | PLD_FEATURE_SOLIDS},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_FLOAT, PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_FLOAT, 0},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_HALF, PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_SOLIDS},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT, all | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, 0},
      {PLD_METHOD_WEIGHTED, PLD_TIER_HALF, kTold | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION},
      {PLD_METHOD_FRONT_TAIL, PLD_TIER_FLOAT, PLD_FEATURE_IDENTITY | PLD_FEATURE_COLOURED},
      {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT, all | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION | kTold},
      {PLD_METHOD_OVER, PLD_TIER_EXACT, PLD_FEATURE_SOLIDS | kTold}};
  int compiled = 0, skipped = 0;
  for (const Case& one : cases)
    for (const pld_depth depth : {PLD_DEPTH_DEVICE, PLD_DEPTH_LINEAR}) {
      pld_create_info info = host.info();
      info.method = one.method;
      info.tier = one.tier;
      info.features = one.features;
      info.depth = depth;
      info.fragments_per_pixel = 4.0f;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      // Half of them with constants in place of the block's numbers.
      const pld_frame frame = host.frame();
      ASSERT_EQ(pld_fix(pass, &frame, depth == PLD_DEPTH_LINEAR ? 127u : 0u), PLD_OK) << pld_message(pass);
      for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_FRONT, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW})
        for (const int version : {330, 400, 410, 420, 430, 440, 450, 460}) {
          const char* seam = nullptr;
          const pld_status status = pld_glsl(pass, stage, version, &seam);
          const bool has = stage == PLD_STAGE_LAYERS ||
                           (stage == PLD_STAGE_FRONT && one.tier != PLD_TIER_EXACT &&
                            (one.method == PLD_METHOD_FRONT_TAIL || (one.features & PLD_FEATURE_IDENTITY))) ||
                           (stage == PLD_STAGE_LOW && (one.features & PLD_FEATURE_LOW_RESOLUTION)) ||
                           (stage == PLD_STAGE_RIMS && (one.features & PLD_FEATURE_RIMS) &&
                            one.method != PLD_METHOD_FRONT_TAIL && one.tier != PLD_TIER_PUBLISHED) ||
                           (stage == PLD_STAGE_SOLIDS && (one.features & PLD_FEATURE_SOLIDS));
          const bool late = one.tier == PLD_TIER_EXACT && version < 430;
          ASSERT_EQ(status, !has ? PLD_ERROR_ARGUMENT : late ? PLD_ERROR_UNSUPPORTED : PLD_OK);
          if (!has || late) continue;
          if (version > most) {
            ++skipped;
            continue;
          }
          const std::string first = "#version " + std::to_string(version) + " core\n";
          const GLuint program = makeProgram(first + kHostVertex, first + seam + kHostShader);
          ASSERT_NE(program, 0u) << "GLSL " << version << " stage " << stage;
          EXPECT_EQ(pld_connect(pass, program), PLD_OK);
          const GLuint block = glGetUniformBlockIndex(program, "PldFrame");
          ASSERT_NE(block, GL_INVALID_INDEX);
          GLint binding = 0;
          glGetActiveUniformBlockiv(program, block, GL_UNIFORM_BLOCK_BINDING, &binding);
          EXPECT_EQ(binding, static_cast<GLint>(info.uniform_binding));
          glDeleteProgram(program);
          ++compiled;
        }
      pld_destroy(&pass);
    }
  std::printf("seams compiled: %d; of versions above this driver's %d: %d\n", compiled, most, skipped);
  EXPECT_GT(compiled, 100);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

// What a driver has to say of a text that compiles: "used uninitialized" and the like, which it reports as severe.
TEST(BridgeGlsl, TheTextsGiveNoWarnings) {
  GlContext context;
  static std::vector<std::string> severe;
  severe.clear();
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(
      [](GLenum, GLenum, GLuint, GLenum severity, GLsizei, const GLchar* text, const void*) {
        if (severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM) severe.emplace_back(text);
      },
      nullptr);
  // A driver that keeps compiled texts on disk says nothing of one that it knows: these it never met.
  const std::string fresh = "// " + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + "\n";
  Host host(16, 16);
  constexpr uint32_t all = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                           PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
  const std::pair<pld_tier, uint32_t> kinds[] = {{PLD_TIER_FLOAT, all},
                                                 {PLD_TIER_FLOAT, PLD_FEATURE_RIMS},
                                                 {PLD_TIER_HALF, PLD_FEATURE_RIMS | PLD_FEATURE_COLOURED},
                                                 {PLD_TIER_PUBLISHED, PLD_FEATURE_RIMS | PLD_FEATURE_REFRACTION},
                                                 {PLD_TIER_EXACT, all},
                                                 {PLD_TIER_FLOAT, PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | kTold},
                                                 {PLD_TIER_HALF, PLD_FEATURE_MOTION},
                                                 {PLD_TIER_EXACT, all | kTold}};
  int compiled = 0;
  for (const auto& [tier, features] : kinds) {
    pld_create_info info = host.info();
    info.tier = tier;
    info.features = features;
    info.fragments_per_pixel = 4.0f;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_FRONT, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW})
      for (const int version : {330, 450}) {
        const char* seam = nullptr;
        if (pld_glsl(pass, stage, version, &seam) != PLD_OK) continue;
        // Of a material without rims, which leaves what a rim would say as it is.
        const GLuint program =
            makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + fresh + seam +
                                               "void main() { pldWriteFragment(pldSurface(vec3(0.2), 0.5, vec3(0.5), "
                                               "vec3(0.0, 0.0, -3.0))); }\n");
        ASSERT_NE(program, 0u);
        glDeleteProgram(program);
        ++compiled;
        for (const std::string& text : severe) ADD_FAILURE() << "stage " << stage << ", " << version << ": " << text;
        severe.clear();
      }
    pld_destroy(&pass);
  }
  EXPECT_GT(compiled, 15);
  // The callback is called: by a text that is worth a warning.
  severe.clear();
  makeProgram(kFullscreenVertex, "#version 450 core\n" + fresh + "out vec4 c;\nvec4 v;\nvoid main() { c = v; }\n");
  EXPECT_FALSE(severe.empty());
}

// Twice in one shader, as includes happen to be.
TEST(BridgeGlsl, TheTextGuardsItself) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const char* seam = nullptr;
  ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 330, &seam), PLD_OK);
  const GLuint program = makeProgram(std::string("#version 330 core\n") + kHostVertex,
                                     std::string("#version 330 core\n") + seam + seam + kHostShader);
  EXPECT_NE(program, 0u);
  glDeleteProgram(program);
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
