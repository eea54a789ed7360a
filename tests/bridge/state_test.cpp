// Every call leaves GL as it found it, and so does every call that fails; the picture does not depend on what it found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/bridge/gl_state.h"
#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"

namespace pellucid::test {
namespace {

constexpr uint32_t kAll = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                          PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS;
constexpr uint32_t kFlags = PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS | PLD_FLAG_DEBUG_VIEWS;

struct Watch {
  GlState before = glState();
  int calls = 0;
  void unchanged(const char* call) {
    ++calls;
    for (const std::string& one : changes(before, glState())) ADD_FAILURE() << call << " leaves " << one;
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << call;
  }
};

struct Kind {
  pld_method method;
  pld_tier tier;
  uint32_t features;
  pld_depth depth;
  std::vector<pld_stage> stages;
};
const Kind kKinds[] = {
    {PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_FLOAT, kAll, PLD_DEPTH_LINEAR, {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}},
    {PLD_METHOD_PHENOMENOLOGICAL,
     PLD_TIER_FLOAT,
     kAll | PLD_FEATURE_LOW_RESOLUTION,
     PLD_DEPTH_LINEAR,
     {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_LOW}},
    {PLD_METHOD_FRONT_TAIL,
     PLD_TIER_HALF,
     PLD_FEATURE_LIGHT | PLD_FEATURE_RIMS,
     PLD_DEPTH_REVERSED,
     {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}},
    {PLD_METHOD_FRONT_TAIL,
     PLD_TIER_HALF,
     PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
     PLD_DEPTH_LINEAR,
     {PLD_STAGE_FRONT, PLD_STAGE_LAYERS, PLD_STAGE_LOW}},
    {PLD_METHOD_WEIGHTED, PLD_TIER_PUBLISHED, PLD_FEATURE_RIMS, PLD_DEPTH_DEVICE, {PLD_STAGE_LAYERS}},
    {PLD_METHOD_WEIGHTED,
     PLD_TIER_FLOAT,
     PLD_FEATURE_RIMS | PLD_FEATURE_LIGHT,
     PLD_DEPTH_DEVICE,
     {PLD_STAGE_LAYERS, PLD_STAGE_RIMS}},
    {PLD_METHOD_WEIGHTED,
     PLD_TIER_HALF,
     PLD_FEATURE_LOW_RESOLUTION | PLD_FEATURE_SOLIDS,
     PLD_DEPTH_REVERSED,
     {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_LOW}},
    {PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, 0, PLD_DEPTH_DEVICE, {PLD_STAGE_LAYERS}},
    {PLD_METHOD_PHENOMENOLOGICAL,
     PLD_TIER_EXACT,
     kAll | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
     PLD_DEPTH_REVERSED,
     {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}}};

// What a host's own draws change: culling and the like, which it puts back itself.
void setShape(bool unlikely) {
  const auto choose = [&](GLenum what) { unlikely ? glEnable(what) : glDisable(what); };
  choose(GL_CULL_FACE);
  choose(GL_RASTERIZER_DISCARD);
  for (GLenum i = 0; i < 8; ++i) choose(GL_CLIP_DISTANCE0 + i);
  glPolygonMode(GL_FRONT_AND_BACK, unlikely ? GL_LINE : GL_FILL);
  glClipControl(unlikely ? GL_UPPER_LEFT : GL_LOWER_LEFT, unlikely ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
  for (GLuint i = 0; i < 16; ++i) glDepthRangeIndexed(i, unlikely ? 0.125 : 0.0, unlikely ? 0.75 : 1.0);
}

void drawSomething(pld_pass* pass, pld_stage stage) {
  const char* seam = nullptr;
  ASSERT_EQ(pld_glsl(pass, stage, 450, &seam), PLD_OK);
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam +
                                                            "void main() { pldWriteFragment(pldSurface(vec3(0.2), 0.5, "
                                                            "vec3(0.5), vec3(0.0, 0.0, -3.0))); }\n");
  ASSERT_NE(program, 0u);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

TEST(BridgeState, EveryCallLeavesGlAsItFoundIt) {
  for (const Kind& setup : kKinds) {
    GlContext context;
    Host host(40, 30);
    const GLuint device = makeTexture(GL_DEPTH_COMPONENT32F, 40, 30);
    const GLuint other = makeTexture(GL_R8, 40, 30);
    GLuint bare = 0;
    glCreateFramebuffers(1, &bare);
    setUnlikelyState();
    ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    Watch watch;
    pld_create_info info = host.info();
    info.method = setup.method;
    info.features = setup.features;
    info.flags = kFlags;
    info.depth = setup.depth;
    info.rows = PLD_ROWS_UP;
    info.tier = PLD_TIER_EXACT;
    pld_pass* pass = nullptr;
    const bool never = setup.method == PLD_METHOD_FRONT_TAIL && (setup.features & PLD_FEATURE_LOW_RESOLUTION);
    EXPECT_EQ(pld_create(&info, &pass), never ? PLD_ERROR_UNSUPPORTED : PLD_ERROR_ARGUMENT);  // no room
    watch.unchanged("pld_create that fails");
    info.tier = setup.tier;
    info.fragments_per_pixel = 4.0f;
    info.storage_binding = 3;
    ASSERT_EQ(pld_create(&info, &pass), PLD_OK) << host.log.last();
    watch.unchanged("pld_create");
    EXPECT_EQ(pld_resize(pass, -1, 5), PLD_ERROR_SIZE);
    watch.unchanged("pld_resize that fails");
    EXPECT_EQ(pld_resize(pass, 64, 64), PLD_OK);
    watch.unchanged("pld_resize");
    EXPECT_EQ(pld_resize(pass, 40, 30), PLD_OK);
    watch.unchanged("pld_resize to another size");
    pld_frame frame = host.frame();
    if (setup.depth != PLD_DEPTH_LINEAR) frame.depth_texture = device;
    if (setup.depth == PLD_DEPTH_REVERSED)
      for (const int k : {10, 14}) frame.projection[k] *= -1.0f;
    for (const pld_stage stage : setup.stages) {
      pld_frame wrong = frame;
      wrong.depth_texture = other;
      EXPECT_EQ(pld_begin(pass, stage, &wrong), PLD_ERROR_FORMAT);
      wrong.depth_texture = 9999;
      EXPECT_EQ(pld_begin(pass, stage, &wrong), PLD_ERROR_TEXTURE);
      wrong = frame;
      wrong.width = 41;
      EXPECT_EQ(pld_begin(pass, stage, &wrong), PLD_ERROR_SIZE);
      EXPECT_EQ(pld_end(pass), PLD_ERROR_ORDER);
      watch.unchanged("pld_begin that fails");
      ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
      setShape(false);
      drawSomething(pass, stage);
      EXPECT_EQ(pld_begin(pass, stage, &frame), PLD_ERROR_ORDER);
      pld_target target = host.target();
      EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_ORDER);
      setShape(true);
      ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
      watch.unchanged("pld_begin, draws, pld_end");
    }
    pld_target target = host.target();
    target.name = host.colour;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_TEXTURE);
    target.name = device;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_FORMAT);
    target.name = bare;
    target.kind = PLD_TARGET_FRAMEBUFFER;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_FORMAT);
    glNamedFramebufferTexture(bare, GL_COLOR_ATTACHMENT0, host.colour, 0);
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_TEXTURE);
    watch.unchanged("pld_resolve that fails");
    glNamedFramebufferTexture(bare, GL_COLOR_ATTACHMENT0, host.output, 0);
    EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    watch.unchanged("pld_resolve to a framebuffer");
    target = host.target();
    EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    watch.unchanged("pld_resolve");
    for (int view = PLD_VIEW_LAYER_COUNT; view <= PLD_VIEW_LOW_DEPTH; ++view) {
      target.view = static_cast<pld_view>(view);
      const pld_stage needed = view <= PLD_VIEW_SOLID      ? PLD_STAGE_LAYERS
                               : view <= PLD_VIEW_RIM_LOSS ? PLD_STAGE_RIMS
                                                           : PLD_STAGE_LOW;
      const bool has = std::find(setup.stages.begin(), setup.stages.end(), needed) != setup.stages.end();
      EXPECT_EQ(pld_resolve(pass, &target), has ? PLD_OK : PLD_ERROR_UNSUPPORTED) << pld_message(pass);
      watch.unchanged("pld_resolve of a view");
    }
    glFinish();
    uint64_t value = 0;
    EXPECT_EQ(pld_query(pass, PLD_VALUE_NS_RESOLVE, &value), PLD_OK) << pld_message(pass);
    EXPECT_GT(value, 0u);
    EXPECT_EQ(pld_query(pass, PLD_VALUE_BYTES, &value), PLD_OK);
    EXPECT_GT(value, 40u * 30u);
    const char* seam = nullptr;
    const int version = setup.tier == PLD_TIER_EXACT ? 430 : 330;
    EXPECT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, version, &seam), PLD_OK);
    const GLuint program = makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + seam +
                                                              "void main() { pldWriteFragment(pldSurface(vec3(1.0), "
                                                              "0.5, vec3(0.0), gl_FragCoord.xyz)); }\n");
    EXPECT_EQ(pld_connect(pass, program), PLD_OK);
    EXPECT_EQ(pld_connect(pass, 9999), PLD_ERROR_ARGUMENT);
    watch.unchanged("pld_query, pld_glsl, pld_connect");
    EXPECT_EQ(pld_destroy(&pass), PLD_OK);
    watch.unchanged("pld_destroy");
    glPopDebugGroup();  // the driver keeps the names of those that are open for ever
    std::printf("state: %zu pieces of state equal after each of %d steps\n", watch.before.size(), watch.calls);
  }
}

// The exact tier, when more fragments come than fit.
TEST(BridgeState, AStageWithoutRoomLeavesGlAsItFoundIt) {
  GlContext context;
  Host host(40, 30);
  setUnlikelyState();
  pld_create_info info = host.info();
  info.features = kAll | PLD_FEATURE_RIMS;
  info.flags = kFlags;
  info.tier = PLD_TIER_EXACT;
  info.fragments_per_pixel = 1.5f;
  info.storage_binding = 2;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  Watch watch;
  for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS}) {
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    setShape(false);
    for (int i = 0; i < (stage == PLD_STAGE_LAYERS ? 2 : 1); ++i) drawSomething(pass, stage);
    setShape(true);
    ASSERT_EQ(pld_end(pass), stage == PLD_STAGE_LAYERS ? PLD_ERROR_MEMORY : PLD_OK) << pld_message(pass);
    watch.unchanged("pld_end");
    if (stage != PLD_STAGE_LAYERS) continue;
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_RIMS, &frame), PLD_ERROR_ORDER);
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    watch.unchanged("pld_end of the stage again");
  }
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  glPopDebugGroup();
}

// The same for shadow maps.
TEST(BridgeState, ShadowCallsLeaveGlAsTheyFoundIt) {
  for (const bool coloured : {false, true}) {
    GlContext context;
    Host host(40, 30);
    const GLuint device = makeTexture(GL_DEPTH24_STENCIL8, 64, 64), small = makeTexture(GL_DEPTH_COMPONENT32F, 32, 64),
                 face = makeTexture(GL_RGBA8, 64, 64);
    setUnlikelyState();
    GLuint array = 0;
    glGenTextures(1, &array);
    glActiveTexture(GL_TEXTURE0);  // where views of maps are looked up
    glBindTexture(GL_TEXTURE_2D_ARRAY, array);
    glActiveTexture(GL_TEXTURE5);
    pld_create_info create = host.info();
    create.flags = kFlags;
    pld_pass* pass = host.create(create);
    ASSERT_NE(pass, nullptr);
    Watch watch;
    pld_shadow_info info = shadowInfo(coloured ? PLD_SHADOW_VARIANCE : PLD_SHADOW_CORRECTED, 64, 2, 7, coloured);
    info.size = 65;
    EXPECT_EQ(pld_shadow_resize(pass, &info), PLD_ERROR_SIZE);
    watch.unchanged("pld_shadow_resize that fails");
    info.size = 64;
    ASSERT_EQ(pld_shadow_resize(pass, &info), PLD_OK) << pld_message(pass);
    watch.unchanged("pld_shadow_resize");
    pld_shadow_view view = plainShadowView();
    view.depth_texture = small;
    EXPECT_EQ(pld_shadow_begin(pass, &view), PLD_ERROR_SIZE);
    EXPECT_EQ(pld_shadow_end(pass), PLD_ERROR_ORDER);
    watch.unchanged("pld_shadow_begin that fails");
    for (const GLuint depth : {0u, device}) {
      view.depth_texture = depth;
      ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
      setShape(false);
      const char* seam = nullptr;
      ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 330, &seam), PLD_OK) << pld_message(pass);
      const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 330 core\n") + seam + kPlainCaster);
      ASSERT_EQ(pld_connect(pass, program), PLD_OK);
      glUseProgram(program);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      const pld_frame frame = host.frame();
      EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ORDER);
      EXPECT_EQ(pld_shadow_begin(pass, &view), PLD_ERROR_ORDER);
      setShape(true);
      ASSERT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
      watch.unchanged("pld_shadow_begin, draws, pld_shadow_end");
    }
    glFinish();
    uint64_t time = 0;
    EXPECT_EQ(pld_query(pass, PLD_VALUE_NS_SHADOW, &time), PLD_OK) << pld_message(pass);
    EXPECT_GT(time, 0u);
    watch.unchanged("pld_query of a face's time");
    GLuint bare = 0;
    glCreateFramebuffers(1, &bare);
    for (int shown = PLD_VIEW_SHADOW_TRANSMISSION; shown <= PLD_VIEW_SHADOW_DEPTH; ++shown) {
      pld_target target = host.target();
      target.name = face;
      target.view = static_cast<pld_view>(shown);
      EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
      watch.unchanged("pld_resolve of a shadow map");
      target.kind = PLD_TARGET_FRAMEBUFFER;
      target.name = bare;
      EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_FORMAT);
      target.shadow_face = 1;
      EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_ORDER);
      watch.unchanged("pld_resolve of a shadow map that fails");
    }
    const char* lookup = nullptr;
    EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, 330, &lookup), PLD_OK);
    const GLuint program = makeProgram(
        kFullscreenVertex, std::string("#version 330 core\n") + lookup +
                               "out vec4 c;\nvoid main() { c = vec4(pldShadow(0, gl_FragCoord.xyz), 1.0); }\n");
    EXPECT_EQ(pld_connect(pass, program), PLD_OK);
    watch.unchanged("pld_shadow_glsl, pld_connect");
    EXPECT_EQ(pld_shadow_resize(pass, nullptr), PLD_OK);
    watch.unchanged("pld_shadow_resize to nothing");
    EXPECT_EQ(pld_destroy(&pass), PLD_OK);
    watch.unchanged("pld_destroy");
    glPopDebugGroup();
    std::printf("state: %zu pieces of state equal after each of %d steps with shadow maps\n", watch.before.size(),
                watch.calls);
  }
}

// The watch sees a change: without this, equality shows nothing.
TEST(BridgeState, TheWatchSeesChanges) {
  GlContext context;
  setUnlikelyState();
  const GlState before = glState();
  glDisablei(GL_BLEND, 4);
  glBindSampler(9, 0);
  glViewportIndexedf(0, 0, 0, 5, 5);
  glPopDebugGroup();
  EXPECT_EQ(changes(before, glState()).size(), 4u);
}

// What the host has set meanwhile does not reach the picture.
TEST(BridgeState, ThePictureDoesNotDependOnTheHostsState) {
  std::vector<float> pictures[2];
  for (const bool unlikely : {false, true}) {
    GlContext context;
    Host host(40, 30);
    pld_create_info info = host.info();
    info.features = kAll;
    GLuint array = 0;
    glCreateVertexArrays(1, &array);
    glBindVertexArray(array);
    if (unlikely) setUnlikelyState();
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    const pld_frame frame = host.frame();
    for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}) {
      ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
      setShape(false);
      drawSomething(pass, stage);
      if (unlikely) setShape(true);
      ASSERT_EQ(pld_end(pass), PLD_OK);
    }
    const pld_target target = host.target();
    ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (const GLenum what : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS}) glPixelStorei(what, 0);
    pictures[unlikely] = host.picture();
    pld_destroy(&pass);
    if (unlikely) glPopDebugGroup();
  }
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  EXPECT_EQ(std::memcmp(pictures[0].data(), pictures[1].data(), pictures[0].size() * sizeof(float)), 0);
  EXPECT_NE(pictures[0][0], 0.5f);  // something was drawn
}

// A host that puts its state back itself gets a pass that asks for none of it.
TEST(BridgeState, AHostThatRestoresGetsTheSamePicture) {
  std::vector<float> pictures[2], maps[2];
  for (const bool restores : {false, true}) {
    GlContext context;
    Host host(40, 30);
    pld_create_info info = host.info();
    info.features = PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
    info.flags = restores ? static_cast<uint32_t>(PLD_FLAG_HOST_RESTORES) : 0u;
    GLuint array = 0;
    glCreateVertexArrays(1, &array);
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    const pld_shadow_info room = shadowInfo(PLD_SHADOW_VARIANCE, 64, 1, 1, true);
    ASSERT_EQ(pld_shadow_resize(pass, &room), PLD_OK);
    const char* seam = nullptr;
    ASSERT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &seam), PLD_OK);
    const GLuint caster = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + kPlainCaster);
    const pld_shadow_view view = plainShadowView();
    ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK);
    glUseProgram(caster);
    glBindVertexArray(array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    ASSERT_EQ(pld_shadow_end(pass), PLD_OK);
    maps[restores] = shadowTexels(pass, 16, 3);
    const pld_frame frame = host.frame();
    for (const pld_stage stage : {PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}) {
      ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK);
      glBindVertexArray(array);
      drawSomething(pass, stage);
      ASSERT_EQ(pld_end(pass), PLD_OK);
      GLint bound = 0;
      glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
      EXPECT_EQ(bound != 0, restores);
    }
    const pld_target target = host.target();
    ASSERT_EQ(pld_resolve(pass, &target), PLD_OK);
    pictures[restores] = host.picture();
    pld_destroy(&pass);
  }
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_EQ(maps[0], maps[1]);
  EXPECT_NE(pictures[0][0], 0.5f);
  EXPECT_GT(maps[0][0], 0.0f);
}

// As it is with textures: nothing is bound where what was bound is no more.
TEST(BridgeState, BuffersThatTheHostDeletesMeanwhileAreNotBoundAgain) {
  GlContext context;
  Host host(8, 8);
  pld_create_info info = host.info();
  info.tier = PLD_TIER_EXACT;
  info.fragments_per_pixel = 1.0f;
  info.storage_binding = 2;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  GLuint buffers[2] = {};
  glGenBuffers(2, buffers);
  const std::pair<GLenum, GLuint> places[] = {{GL_SHADER_STORAGE_BUFFER, info.storage_binding},
                                              {GL_UNIFORM_BUFFER, info.uniform_binding}};
  for (int i = 0; i < 2; ++i) {
    glBindBuffer(places[i].first, buffers[i]);
    glBufferData(places[i].first, 256, nullptr, GL_STATIC_DRAW);
    glBindBufferBase(places[i].first, places[i].second, buffers[i]);
  }
  const pld_frame frame = host.frame();
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  glDeleteBuffers(2, buffers);
  EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  GLint bound = -1;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, info.storage_binding, &bound);
  EXPECT_EQ(bound, 0);
  glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, info.uniform_binding, &bound);
  EXPECT_EQ(bound, 0);
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

}  // namespace
}  // namespace pellucid::test
