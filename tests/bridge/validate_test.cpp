// PLD_FLAG_VALIDATE: what went wrong between a begin and its end is said at the end; without it nothing is looked at.
#include <gtest/gtest.h>

#include <functional>

#include "tests/bridge/gl_state.h"
#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kBoth[] = {0u, PLD_FLAG_VALIDATE};
constexpr uint32_t kAll = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                          PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS;
const char* const kLayer =
    "void main() { pldWriteFragment(pldSurface(vec3(0.2), 0.5, vec3(0.5), vec3(0.0, 0.0, -3.0))); }\n";

bool says(const char* message, const char* word) {
  return std::string(message).find(word) != std::string::npos;
}

GLuint layerProgram(pld_pass* pass, pld_stage stage, int version) {
  const char* seam = nullptr;
  EXPECT_EQ(pld_glsl(pass, stage, version, &seam), PLD_OK) << pld_message(pass);
  const GLuint program =
      makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + seam + kLayer);
  EXPECT_NE(program, 0u);
  return program;
}

// A pass, and what a host has.
struct Engine {
  GlContext context;
  Host host{24, 16};
  pld_pass* pass = nullptr;
  GLuint array = 0;
  bool validates;

  Engine(
      uint32_t flags, const std::function<void(pld_create_info&)>& change = [](pld_create_info&) {})
      : validates((flags & PLD_FLAG_VALIDATE) != 0) {
    pld_create_info info = host.info();
    info.flags = flags;
    info.fragments_per_pixel = 4.0f;
    info.storage_binding = 2;
    change(info);
    pass = host.create(info);
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
  }
  ~Engine() { pld_destroy(&pass); }

  pld_status stage(pld_stage stage, const std::function<void()>& draws) {
    const pld_frame frame = host.frame();
    EXPECT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    draws();
    return pld_end(pass);
  }
  // Expects the end to say so under validation, and nothing without; and GL and the frame to go on all the same.
  void misused(pld_stage at, const std::function<void()>& draws, const char* word, const char* other = "") {
    const GlState before = glState();
    const pld_status status = stage(at, draws);
    EXPECT_STREQ(pld_status_name(status), validates ? "PLD_ERROR_MISUSE" : "PLD_OK") << word;
    if (validates) {
      EXPECT_TRUE(says(pld_message(pass), word) && says(pld_message(pass), other)) << word << ": " << pld_message(pass);
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    for (const std::string& one : changes(before, glState())) ADD_FAILURE() << word << " leaves " << one;
  }
};

void draw(GLuint program) {
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

// Every kind of pass, drawn as it should be, with programs of a version that needs to be connected where there is one.
TEST(BridgeValidate, ARightFrameIsRightAndHasTheSameBits) {
  struct Kind {
    pld_method method;
    pld_tier tier;
    uint32_t features;
    std::vector<pld_stage> stages;
  };
  const Kind kinds[] = {{PLD_METHOD_PHENOMENOLOGICAL,
                         PLD_TIER_FLOAT,
                         kAll | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
                         {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}},
                        {PLD_METHOD_FRONT_TAIL, PLD_TIER_HALF, PLD_FEATURE_RIMS, {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}},
                        {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, PLD_FEATURE_REFRACTION, {PLD_STAGE_LAYERS}},
                        {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_EXACT, kAll, {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}}};
  for (const Kind& kind : kinds) {
    std::vector<float> pictures[2];
    for (const uint32_t flags : kBoth) {
      Engine engine(flags, [&](pld_create_info& info) {
        info.method = kind.method;
        info.tier = kind.tier;
        info.features = kind.features;
      });
      const pld_frame fixed = engine.host.frame();
      ASSERT_EQ(pld_fix(engine.pass, &fixed, PLD_FIXED_UNITS | PLD_FIXED_WEIGHT), PLD_OK);
      for (const pld_stage stage : kind.stages) {
        const GLuint program = layerProgram(engine.pass, stage, kind.tier == PLD_TIER_EXACT ? 430 : 330);
        ASSERT_EQ(pld_connect(engine.pass, program), PLD_OK);
        EXPECT_EQ(engine.stage(stage, [&] { draw(program); }), PLD_OK) << pld_message(engine.pass);
      }
      const pld_target target = engine.host.target();
      ASSERT_EQ(pld_resolve(engine.pass, &target), PLD_OK) << pld_message(engine.pass);
      pictures[flags != 0] = engine.host.picture();
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_NE(pictures[0][0], 0.5f);  // something was drawn
  }
}

TEST(BridgeValidate, AProgramThatIsNotConnectedIsFound) {
  for (const uint32_t flags : kBoth) {
    Engine engine(flags);
    const GLuint program = layerProgram(engine.pass, PLD_STAGE_LAYERS, 330);
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(program); }, "not connected", "PldFrame at binding 0, expected 3");
    // And one of which the samplers alone are others'.
    ASSERT_EQ(pld_connect(engine.pass, program), PLD_OK);
    const GLint place = glGetUniformLocation(program, "pldOpaqueZ");
    ASSERT_GE(place, 0);
    glProgramUniform1i(program, place, 9);
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(program); }, "not connected", "pldOpaqueZ at unit 9, expected 4");
    ASSERT_EQ(pld_connect(engine.pass, program), PLD_OK);
    EXPECT_EQ(engine.stage(PLD_STAGE_LAYERS, [&] { draw(program); }), PLD_OK) << pld_message(engine.pass);
  }
}

TEST(BridgeValidate, SeamsOfOtherStagesAndPassesAreFound) {
  for (const uint32_t flags : kBoth) {
    Engine engine(flags, [](pld_create_info& info) { info.method = PLD_METHOD_FRONT_TAIL; });
    const GLuint front = layerProgram(engine.pass, PLD_STAGE_FRONT, 450),
                 layers = layerProgram(engine.pass, PLD_STAGE_LAYERS, 450),
                 plain = makeProgram(kFullscreenVertex,
                                     "#version 450 core\nout vec4 colour;\nvoid main() { colour = vec4(0.1); }\n");
    pld_create_info other = engine.host.info();
    other.features = PLD_FEATURE_COLOURED;
    pld_pass* second = engine.host.create(other);
    const GLuint foreign = layerProgram(second, PLD_STAGE_LAYERS, 450);
    engine.misused(
        PLD_STAGE_FRONT, [&] { draw(layers); }, "holds the seam of PLD_STAGE_LAYERS",
        "expected the seam of PLD_STAGE_FRONT");
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(front); }, "holds the seam of PLD_STAGE_FRONT",
        "expected the seam of PLD_STAGE_LAYERS");
    // The frame goes on: what was drawn is drawn.
    const pld_target target = engine.host.target();
    EXPECT_EQ(pld_resolve(engine.pass, &target), PLD_OK) << pld_message(engine.pass);
    EXPECT_EQ(engine.stage(PLD_STAGE_FRONT, [&] { draw(front); }), PLD_OK) << pld_message(engine.pass);
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(foreign); }, "of another pass");
    EXPECT_EQ(engine.stage(PLD_STAGE_FRONT, [&] { draw(front); }), PLD_OK) << pld_message(engine.pass);
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(plain); }, "does not hold the seam of PLD_STAGE_LAYERS");
    EXPECT_EQ(engine.stage(PLD_STAGE_FRONT, [&] { draw(front); }), PLD_OK) << pld_message(engine.pass);
    engine.misused(
        PLD_STAGE_LAYERS,
        [&] {
          draw(layers);
          glUseProgram(0);
        },
        "no program is in use");
    // Where nothing is drawn it does not matter what is in use.
    EXPECT_EQ(engine.stage(PLD_STAGE_FRONT, [] {}), PLD_OK) << pld_message(engine.pass);
    EXPECT_EQ(engine.stage(PLD_STAGE_LAYERS, [&] { glUseProgram(plain); }), PLD_OK) << pld_message(engine.pass);
    pld_destroy(&second);
  }
}

// Two passes of one making share their texts.
TEST(BridgeValidate, AProgramOfAPassThatIsTheSameIsRight) {
  Engine engine(PLD_FLAG_VALIDATE);
  pld_pass* second = engine.host.create(engine.host.info());
  const GLuint program = layerProgram(second, PLD_STAGE_LAYERS, 330);
  ASSERT_EQ(pld_connect(second, program), PLD_OK);
  EXPECT_EQ(engine.stage(PLD_STAGE_LAYERS, [&] { draw(program); }), PLD_OK) << pld_message(engine.pass);
  pld_destroy(&second);
}

TEST(BridgeValidate, StateThatIsNotTheHostsIsLookedAt) {
  for (const pld_tier tier : {PLD_TIER_FLOAT, PLD_TIER_EXACT})
    for (const uint32_t flags : kBoth) {
      Engine engine(flags, [&](pld_create_info& info) { info.tier = tier; });
      const GLuint program = layerProgram(engine.pass, PLD_STAGE_LAYERS, 450);
      GLuint frame = 0, buffer = 0;
      glCreateFramebuffers(1, &frame);
      glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, engine.host.output, 0);
      glCreateBuffers(1, &buffer);
      glNamedBufferData(buffer, 1 << 16, nullptr, GL_STATIC_DRAW);
      const struct {
        const char* what;
        std::function<void()> change;
      } changes[] = {
          {"the draw framebuffer", [&] { glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame); }},
          {"the viewport", [] { glViewportIndexedf(0, 0, 0, 3, 3); }},
          {"blending of draw buffer 1",
           [] {
             glEnablei(GL_BLEND, 1);
             glBlendFunci(1, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
           }},
          {"the colour mask of draw buffer 2", [] { glColorMaski(2, GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE); }},
          {"the depth mask", [] { glDepthMask(GL_TRUE); }},
          {"the depth test", [] { glEnable(GL_DEPTH_TEST); }},
          {"the texture of the seam's unit 4", [&] { glBindTextureUnit(4, engine.host.colour); }},
          {"the uniform buffer at binding 3", [&] { glBindBufferBase(GL_UNIFORM_BUFFER, 3, buffer); }},
          {"the storage buffer at binding 3", [&] { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, buffer); }}};
      for (const auto& one : changes) {
        if (tier != PLD_TIER_EXACT && says(one.what, "storage")) continue;
        engine.misused(
            PLD_STAGE_LAYERS,
            [&] {
              draw(program);
              one.change();
            },
            one.what);
      }
      // What is the host's, and what it puts back.
      EXPECT_EQ(engine.stage(PLD_STAGE_LAYERS,
                             [&] {
                               glEnable(GL_CULL_FACE);
                               glEnable(GL_STENCIL_TEST);
                               glViewport(0, 0, 3, 3);
                               draw(program);
                               glViewport(0, 0, 24, 16);
                               glBindTextureUnit(11, engine.host.colour);
                             }),
                PLD_OK)
          << pld_message(engine.pass);
    }
}

TEST(BridgeValidate, CastersAreLookedAtToo) {
  for (const uint32_t flags : kBoth) {
    Engine engine(flags);
    pld_pass* pass = engine.pass;
    const auto text = [&](pld_shadow_text which, int version, const char* main) {
      const char* found = nullptr;
      EXPECT_EQ(pld_shadow_glsl(pass, which, version, &found), PLD_OK) << pld_message(pass);
      return makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + found + main);
    };
    const auto face = [&](GLuint program, const char* word) {
      const pld_shadow_view view = plainShadowView();
      ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
      draw(program);
      const pld_status status = pld_shadow_end(pass);
      EXPECT_STREQ(pld_status_name(status), word && flags ? "PLD_ERROR_MISUSE" : "PLD_OK") << pld_message(pass);
      if (word && flags) {
        EXPECT_TRUE(says(pld_message(pass), word)) << pld_message(pass);
      }
    };
    pld_shadow_info maps = shadowInfo(PLD_SHADOW_NAIVE, 16, 1, 1, false);
    ASSERT_EQ(pld_shadow_resize(pass, &maps), PLD_OK);
    const GLuint grey = text(PLD_SHADOW_TEXT_CASTER, 450, kPlainCaster);
    maps.coloured = 1;
    ASSERT_EQ(pld_shadow_resize(pass, &maps), PLD_OK);
    const GLuint coloured = text(PLD_SHADOW_TEXT_CASTER, 330, kPlainCaster),
                 layers = layerProgram(pass, PLD_STAGE_LAYERS, 450);
    face(coloured, "not connected");
    ASSERT_EQ(pld_connect(pass, coloured), PLD_OK);
    face(coloured, nullptr);
    face(grey, "expected PLD_SHADOW_TEXT_CASTER of these maps");
    face(layers, "the seam of PLD_STAGE_LAYERS");
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(coloured); }, "PLD_SHADOW_TEXT_CASTER");
    // A layer that asks the maps, without their buffer and with it.
    const char *seam = nullptr, *lookup = nullptr;
    ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK);
    ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, 450, &lookup), PLD_OK);
    const GLuint lit = makeProgram(
        kFullscreenVertex, std::string("#version 450 core\n") + seam + lookup +
                               "void main() { vec3 p = vec3(0.0, 0.0, -3.0); pldWriteFragment(pldSurface(pldShadow(0, "
                               "p), 0.5, vec3(0.5), p)); }\n");
    ASSERT_NE(lit, 0u);
    engine.misused(
        PLD_STAGE_LAYERS, [&] { draw(lit); }, "PLD_VALUE_SHADOW_BUFFER");
    uint64_t buffer = 0;
    ASSERT_EQ(pld_query(pass, PLD_VALUE_SHADOW_BUFFER, &buffer), PLD_OK);
    glBindBufferBase(GL_UNIFORM_BUFFER, maps.uniform_binding, static_cast<GLuint>(buffer));
    EXPECT_EQ(engine.stage(PLD_STAGE_LAYERS, [&] { draw(lit); }), PLD_OK) << pld_message(pass);
  }
}

}  // namespace
}  // namespace pellucid::test
