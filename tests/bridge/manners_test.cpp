// A guest that says what a host gets wrong and takes what a host may well do: each with PLD_FLAG_VALIDATE and without.
#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "tests/bridge/egl_context.h"
#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kBoth[] = {0u, PLD_FLAG_VALIDATE};
constexpr uint32_t kHost0_3 = 3u << 10, kHost0_4 = 4u << 10;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool says(const char* message, const char* word) {
  return std::string(message).find(word) != std::string::npos;
}

// A contract, not a diagnostic.
static_assert(!std::is_same_v<decltype(PLD_FLAG_HOST_RESTORES), pld_flag> && PLD_FLAG_HOST_RESTORES == 1u);

TEST(BridgeManners, AContextThatSharesWithThePasssIsAnother) {
  for (const uint32_t flags : kBoth) {
    const EglContext own(true);
    Host host(16, 16);
    pld_create_info info = host.info();
    info.flags = flags;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    const pld_frame frame = host.frame();
    const pld_target target = host.target();
    const pld_shadow_info maps = shadowInfo(PLD_SHADOW_NAIVE, 64, 1, 1, false);
    ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
    {
      const EglContext other(true, own.name());
      ASSERT_TRUE(glIsTexture(host.colour)) << "the contexts share nothing";
      GLuint arrays[64];  // of the names that the pass's own have
      glGenVertexArrays(64, arrays);
      for (const GLuint array : arrays) glBindVertexArray(array);
      uint64_t value = 0;
      const char* text = nullptr;
      EXPECT_EQ(pld_end(pass), PLD_ERROR_CONTEXT);
      EXPECT_TRUE(says(pld_message(pass), "not current")) << pld_message(pass);
      EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_CONTEXT);
      EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_CONTEXT);
      EXPECT_EQ(pld_resize(pass, 8, 8), PLD_ERROR_CONTEXT);
      EXPECT_EQ(pld_query(pass, PLD_VALUE_BYTES, &value), PLD_ERROR_CONTEXT);
      EXPECT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &text), PLD_ERROR_CONTEXT);
      EXPECT_EQ(pld_shadow_resize(pass, &maps), PLD_ERROR_CONTEXT);
      EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
    EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    EXPECT_EQ(host.finish(pass), readTexture(host.colour, 16, 16, GL_RGBA));
  }
}

// What a face of 64 x 64 texels leaves of the light under a caster that fills it.
//   z, near, far  of the caster in the view's space, and of the view
std::vector<float> lightUnder(pld_light kind, float z, float nearDepth, float farDepth, uint32_t flags) {
  Host host(16, 16);
  pld_create_info create = host.info();
  create.flags = flags;
  pld_pass* pass = host.create(create);
  const pld_shadow_info info = shadowInfo(PLD_SHADOW_VARIANCE, 64, 1, 1, true);
  EXPECT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
  const char* seam = nullptr;
  EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &seam), PLD_OK);
  std::string main = kPlainCaster;
  main.replace(main.find("-2.0"), 4, std::to_string(z));
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + main);
  pld_shadow_view view = plainShadowView();
  view.kind = kind;
  if (kind == PLD_LIGHT_LOCAL) view.projection[11] = -1.0f, view.projection[15] = 0.0f;
  view.near_depth = nearDepth;
  view.far_depth = farDepth;
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  EXPECT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
  glBindVertexArray(array);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  EXPECT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
  const float under = -farDepth - 2.0f;
  const std::vector<float> found = askShadows(pass, info, 0, {0, 0, under, 0, .5f, -.5f, under, 0}, true);
  pld_destroy(&pass);
  glDeleteProgram(program);
  return found;
}

TEST(BridgeManners, ASunsViewKeepsItsCastersWhereverItsOriginLies) {
  GlContext context;
  for (const uint32_t flags : kBoth) {
    const std::vector<float> before = lightUnder(PLD_LIGHT_DIRECTIONAL, -2.0f, 1.0f, 3.0f, flags);
    EXPECT_NEAR(before[0], 1.0f - 0.5f * 0.75f, 1e-3f);
    EXPECT_EQ(lightUnder(PLD_LIGHT_DIRECTIONAL, 0.0f, -1.0f, 1.0f, flags), before);   // at the origin
    EXPECT_EQ(lightUnder(PLD_LIGHT_DIRECTIONAL, 2.0f, -3.0f, -1.0f, flags), before);  // behind it
    // A light that has a place sees what lies before it alone.
    EXPECT_LT(lightUnder(PLD_LIGHT_LOCAL, -2.0f, 0.0f, 4.0f, flags)[0], 0.7f);
    EXPECT_EQ(lightUnder(PLD_LIGHT_LOCAL, 2.0f, 0.0f, 4.0f, flags)[0], 1.0f);
  }
}

// A grey pane over a grey picture of stripes, which bends it.
std::vector<float> bent(const char* etas, uint32_t flags) {
  Host host(32, 32);
  std::vector<float> stripes;
  for (int i = 0; i < 32 * 32; ++i) {
    const float grey = 0.1f + 0.8f * static_cast<float>((i % 32) % 5) / 4.0f;
    stripes.insert(stripes.end(), {grey, grey, grey, 1.0f});
  }
  fillTexture(host.colour, 32, 32, GL_RGBA, stripes.data());
  pld_create_info info = host.info();
  info.flags = flags;
  info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION | PLD_FEATURE_DISPERSION;
  pld_pass* pass = host.create(info);
  const char* seam = nullptr;
  EXPECT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK) << pld_message(pass);
  const std::string main =
      std::string(
          "void main() {\n  PldSurface pane = pldSurface(vec3(0.0), 1.0, vec3(0.9), vec3(0.0, 0.0, "
          "-3.0));\n  pane.normal = normalize(vec3(0.5, 0.2, 1.0));\n") +
      etas + "  pldWriteFragment(pane);\n}\n";
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + main);
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  const pld_frame frame = host.frame();
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  glBindVertexArray(array);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
  return host.finish(pass);
}

TEST(BridgeManners, AMaterialThatSetsEtaAloneBendsAllColoursAlike) {
  GlContext context;
  for (const uint32_t flags : kBoth) {
    const std::vector<float> alone = bent("pane.eta = 1.0 / 1.5;\n", flags);
    EXPECT_EQ(alone, bent("pane.eta = 1.0 / 1.5;\npane.etaRedBlue = vec2(1.0 / 1.5);\n", flags));
    EXPECT_NE(alone, bent("", flags));  // it bends
    float fringe = 0.0f, dispersed = 0.0f;
    const std::vector<float> both =
        bent("pane.eta = 1.0 / 1.5;\npane.etaRedBlue = vec2(1.0 / 1.4, 1.0 / 1.6);\n", flags);
    for (std::size_t i = 0; i < alone.size(); i += 4) {
      fringe = std::max({fringe, std::fabs(alone[i] - alone[i + 1]), std::fabs(alone[i] - alone[i + 2])});
      dispersed = std::max(dispersed, std::fabs(both[i] - both[i + 2]));
    }
    EXPECT_LT(fringe, 1e-6f);
    EXPECT_GT(dispersed, 0.05f);
    // One of the two.
    EXPECT_EQ(bent("pane.eta = 1.0 / 1.5;\npane.etaRedBlue.x = 1.0 / 1.4;\n", flags),
              bent("pane.eta = 1.0 / 1.5;\npane.etaRedBlue = vec2(1.0 / 1.4, 1.0 / 1.5);\n", flags));
  }
}

TEST(BridgeManners, ThePublishedTierRefusesLightThatAdds) {
  GlContext context;
  Host host(8, 8);
  for (const uint32_t flags : kBoth) {
    pld_create_info info = host.info();
    info.flags = flags;
    info.tier = PLD_TIER_PUBLISHED;
    info.features = PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION;
    pld_pass* pass = nullptr;
    host.log.lines.clear();
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_UNSUPPORTED);
    EXPECT_TRUE(says(host.log.last().c_str(), "PLD_FEATURE_LIGHT")) << host.log.last();
    EXPECT_TRUE(says(host.log.last().c_str(), "PLD_TIER_PUBLISHED")) << host.log.last();
    // Hosts of before have what they had, and are told; one of 0.3 did not ask for light by itself.
    info.version = kHost0_4;
    host.log.lines.clear();
    ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
    EXPECT_TRUE(says(host.log.last().c_str(), "PLD_FEATURE_LIGHT")) << host.log.last();
    pld_destroy(&pass);
    info.version = kHost0_3;
    info.features = PLD_FEATURE_REFRACTION;
    host.log.lines.clear();
    ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
    EXPECT_TRUE(host.log.lines.empty()) << host.log.last();
    pld_destroy(&pass);
  }
}

TEST(BridgeManners, PublishedWithFrontTailSaysWhatWouldDo) {
  GlContext context;
  Host host(8, 8);
  pld_create_info info = host.info();
  info.method = PLD_METHOD_FRONT_TAIL;
  info.fragments_per_pixel = 1.0f;
  const std::pair<pld_tier, const char*> tiers[] = {
      {PLD_TIER_FLOAT, "PLD_TIER_FLOAT"}, {PLD_TIER_HALF, "PLD_TIER_HALF"}, {PLD_TIER_EXACT, "PLD_TIER_EXACT"}};
  for (const uint32_t flags : kBoth)
    for (const auto& [tier, name] : tiers) {
      pld_pass* pass = nullptr;
      info.flags = flags;
      info.tier = PLD_TIER_PUBLISHED;
      EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_UNSUPPORTED);
      EXPECT_TRUE(says(host.log.last().c_str(), name)) << host.log.last();
      info.tier = tier;
      EXPECT_EQ(pld_create(&info, &pass), PLD_OK) << host.log.last();
      pld_destroy(&pass);
    }
}

// Kinds of textures that are not one 2D picture, in contexts that can be asked for a texture's kind and in others.
TEST(BridgeManners, TexturesOfOtherKindsAreCalledByTheirNames) {
  for (const bool core : {true, false})
    for (const uint32_t flags : kBoth) {
      const EglContext context(core);
      Host host(16, 16);
      pld_create_info info = host.info();
      info.flags = flags;
      info.features = PLD_FEATURE_RIMS;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      const pld_shadow_info maps = shadowInfo(PLD_SHADOW_NAIVE, 16, 1, 1, false);
      ASSERT_EQ(pld_shadow_resize(pass, &maps), PLD_OK);
      GLuint samples = 0, array = 0, cube = 0;
      glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &samples);
      glTextureStorage2DMultisample(samples, 4, GL_RGBA8, 16, 16, GL_TRUE);
      glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &array);
      glTextureStorage3D(array, 1, GL_RGBA16F, 16, 16, 2);
      glCreateTextures(GL_TEXTURE_CUBE_MAP, 1, &cube);
      glTextureStorage2D(cube, 1, GL_RGBA16F, 16, 16);
      const std::pair<GLuint, const char*> kinds[] = {{samples, "GL_TEXTURE_2D_MULTISAMPLE,"},
                                                      {array, "GL_TEXTURE_2D_ARRAY,"},
                                                      {cube, "GL_TEXTURE_CUBE_MAP:"},
                                                      {0u, "no texture:"},
                                                      {4711u, "no texture of this context"}};
      for (const auto& [name, kind] : kinds) {
        const auto refused = [&](pld_status status, const char* field) {
          EXPECT_EQ(status, PLD_ERROR_TEXTURE) << field;
          EXPECT_TRUE(says(pld_message(pass), kind) && says(pld_message(pass), field)) << pld_message(pass);
          EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        };
        for (uint32_t pld_frame::*field :
             {&pld_frame::colour_texture, &pld_frame::depth_texture, &pld_frame::occlusion_texture}) {
          pld_frame frame = host.frame();
          frame.*field = name;
          refused(pld_begin(pass, PLD_STAGE_LAYERS, &frame), field == &pld_frame::colour_texture ? "colour_texture"
                                                             : field == &pld_frame::depth_texture
                                                                 ? "depth_texture"
                                                                 : "occlusion_texture");
        }
        pld_shadow_view view = plainShadowView();
        view.depth_texture = name;
        if (name) refused(pld_shadow_begin(pass, &view), "depth_texture");
      }
      pld_destroy(&pass);
    }
}

TEST(BridgeManners, NumbersThatAreNotReadMayBeZeroAndAreCalledByTheirNames) {
  struct Field {
    float pld_frame::*number;
    const char* name;
    uint32_t features;  // without which it is not read
    pld_weight weight;
    pld_refract refract;
  };
  const Field fields[] = {
      {&pld_frame::refract_distance, "refract_distance", PLD_FEATURE_REFRACTION, PLD_WEIGHT_BY_EQ5,
       PLD_REFRACT_AT_DISTANCE},
      {&pld_frame::diffusion_k0, "diffusion_k0", PLD_FEATURE_DIFFUSION, PLD_WEIGHT_BY_EQ5, PLD_REFRACT_NOTHING},
      {&pld_frame::diffusion_k1, "diffusion_k1", PLD_FEATURE_DIFFUSION, PLD_WEIGHT_BY_EQ5, PLD_REFRACT_NOTHING},
      {&pld_frame::weight_exponent, "weight_exponent", 0, PLD_WEIGHT_BY_POWER, PLD_REFRACT_NOTHING},
      {&pld_frame::weight_reference, "weight_reference", 0, PLD_WEIGHT_BY_POWER, PLD_REFRACT_NOTHING}};
  GlContext context;
  Host host(8, 8);
  for (const uint32_t flags : kBoth)
    for (const Field& field : fields)
      for (const bool isRead : {false, true}) {
        pld_create_info info = host.info();
        info.flags = flags;
        info.features = isRead ? field.features : 0u;
        info.weight = isRead ? field.weight : PLD_WEIGHT_BY_EQ5;
        pld_pass* pass = host.create(info);
        ASSERT_NE(pass, nullptr);
        pld_frame frame = host.frame();
        frame.refract = field.refract;
        frame.*field.number = kNan;
        EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ARGUMENT) << field.name;
        EXPECT_TRUE(says(pld_message(pass), field.name)) << pld_message(pass);
        EXPECT_EQ(says(pld_message(pass), "does not read"), !isRead) << pld_message(pass);
        frame.*field.number = field.number == &pld_frame::weight_exponent ? -2.5f : -1.0f;
        const bool any = !isRead || field.number == &pld_frame::weight_exponent;
        EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), any ? PLD_OK : PLD_ERROR_ARGUMENT) << pld_message(pass);
        if (any) {
          EXPECT_EQ(pld_end(pass), PLD_OK);
        }
        pld_destroy(&pass);
      }
  // A host of 0.4 that keeps to a pass without scattering was not asked for its numbers.
  pld_create_info old = host.info();
  old.version = kHost0_4;
  pld_pass* pass = host.create(old);
  pld_frame frame = host.frame();
  frame.refract_distance = frame.diffusion_k1 = kNan;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  pld_destroy(&pass);
}

TEST(BridgeManners, AFailedCreationIsHeardWithoutALog) {
  GlContext context;
  Host host(8, 8);
  for (const uint32_t flags : kBoth) {
    char text[200] = "untouched";
    pld_create_info info = host.info();
    info.log = nullptr;
    info.flags = flags;
    info.message = text;
    info.message_size = sizeof(text);
    pld_pass* pass = nullptr;
    ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
    EXPECT_STREQ(text, "");
    pld_destroy(&pass);
    info.uniform_binding = 100000;  // what the device says
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_ARGUMENT);
    EXPECT_TRUE(says(text, "uniform_binding 100000")) << text;
    info.weight = static_cast<pld_weight>(77);  // what the call alone says
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_ARGUMENT);
    EXPECT_TRUE(says(text, "weight: found 77")) << text;
    info.message_size = 8;
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_ARGUMENT);
    EXPECT_STREQ(text, "pld_cre");
    info.message_size = 0;
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_ARGUMENT);
    // As 0.4 and 0.3 had the struct, whose end is no room for a sentence.
    info = host.info();
    info.log = nullptr;
    for (const std::size_t size :
         {offsetof(pld_create_info, message), offsetof(pld_create_info, fragments_per_pixel)}) {
      info.struct_size = static_cast<uint32_t>(size);
      info.version = size == offsetof(pld_create_info, message) ? kHost0_4 : kHost0_3;
      info.message = reinterpret_cast<char*>(1);
      info.message_size = 100;
      ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
      pld_destroy(&pass);
    }
  }
}

TEST(BridgeManners, OnlyAProgramWithATextIsConnected) {
  GlContext context;
  Host host(8, 8);
  const GLuint program =
      makeProgram(kFullscreenVertex, "#version 330 core\nout vec4 c;\nvoid main() { c = vec4(1); }\n");
  for (const uint32_t flags : kBoth) {
    pld_create_info info = host.info();
    info.flags = flags;
    pld_pass* pass = host.create(info);
    EXPECT_EQ(pld_connect(pass, program), PLD_ERROR_ARGUMENT);
    EXPECT_TRUE(says(pld_message(pass), "holds no text")) << pld_message(pass);
    pld_destroy(&pass);
    info.version = kHost0_4;  // could, and is told
    pass = host.create(info);
    host.log.lines.clear();
    EXPECT_EQ(pld_connect(pass, program), PLD_OK);
    EXPECT_TRUE(says(host.log.last().c_str(), "holds no text")) << host.log.last();
    pld_destroy(&pass);
  }
}

}  // namespace
}  // namespace pellucid::test
