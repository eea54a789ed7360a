// Whatever a host does wrong comes back as an error code and a sentence, and a right frame after it is right.
#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "engine_bridge/include/pellucid/recipe.h"
#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

// Every refusal has a sentence, and leaves no GL error behind.
void expectRefused(pld_pass* pass, pld_status status, pld_status expected, const char* what) {
  EXPECT_STREQ(pld_status_name(status), pld_status_name(expected)) << what << ": " << pld_message(pass);
  EXPECT_GT(std::string(pld_message(pass)).size(), 10u) << what;
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << what;
}

TEST(BridgeMisuse, CreateRefusesWhatItCannotKeep) {
  GlContext context;
  Host host(8, 8);
  pld_pass* pass = reinterpret_cast<pld_pass*>(&host);
  pld_create_info info = host.info();
  EXPECT_EQ(pld_create(nullptr, &pass), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pass, nullptr);
  EXPECT_EQ(pld_create(&info, nullptr), PLD_ERROR_ARGUMENT);
  const auto refused = [&](auto change, pld_status expected, const char* what) {
    pld_create_info changed = host.info();
    change(changed);
    host.log.lines.clear();
    EXPECT_STREQ(pld_status_name(pld_create(&changed, &pass)), pld_status_name(expected))
        << what << " " << host.log.last();
    EXPECT_EQ(pass, nullptr) << what;
    if (expected != PLD_ERROR_VERSION || changed.struct_size == sizeof(changed)) {
      EXPECT_GT(host.log.last().size(), 10u) << what;
    }
  };
  refused([](auto& i) { i.struct_size -= 4; }, PLD_ERROR_VERSION, "struct_size");
  refused([](auto& i) { i.version = PLD_VERSION + (1 << 10); }, PLD_ERROR_VERSION, "version");
  refused([](auto& i) { i.get_proc_address = nullptr; }, PLD_ERROR_ARGUMENT, "get_proc_address");
  refused([](auto& i) { i.get_proc_address = [](void*, const char*) -> pld_proc { return nullptr; }; },
          PLD_ERROR_CONTEXT, "no GL");
  refused(
      [](auto& i) {
        i.get_proc_address = [](void* user, const char* name) -> pld_proc {
          return std::string(name) == "glClearBufferfv" ? nullptr : procAddress(user, name);
        };
      },
      PLD_ERROR_UNSUPPORTED, "a function is missing");
  refused([](auto& i) { i.method = static_cast<pld_method>(9); }, PLD_ERROR_ARGUMENT, "method");
  refused([](auto& i) { i.tier = static_cast<pld_tier>(-1); }, PLD_ERROR_ARGUMENT, "tier");
  for (const float room :
       {0.0f, -1.0f, 1e9f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    refused(
        [&](auto& i) {
          i.tier = PLD_TIER_EXACT;
          i.fragments_per_pixel = room;
        },
        PLD_ERROR_ARGUMENT, "exact, without room or with too much");
  refused(
      [](auto& i) {
        i.tier = PLD_TIER_EXACT;
        i.fragments_per_pixel = 8.0f;
        i.storage_binding = 1000;
      },
      PLD_ERROR_ARGUMENT, "storage_binding");
  refused(
      [](auto& i) {
        i.tier = PLD_TIER_EXACT;
        i.fragments_per_pixel = 8.0f;
        i.struct_size = offsetof(pld_create_info, fragments_per_pixel);
      },
      PLD_ERROR_ARGUMENT, "exact, by a header that states no room");
  refused([](auto& i) { i.features = 1u << 30; }, PLD_ERROR_ARGUMENT, "features");
  refused([](auto& i) { i.flags = 1u << 30; }, PLD_ERROR_ARGUMENT, "flags");
  refused([](auto& i) { i.weight = static_cast<pld_weight>(44); }, PLD_ERROR_ARGUMENT, "weight");
  refused([](auto& i) { i.uniform_binding = 100000; }, PLD_ERROR_ARGUMENT, "uniform_binding");
  refused(
      [](auto& i) {
        i.texture_unit = 15;
        i.features = 0;
        i.texture_unit = 1000;
      },
      PLD_ERROR_ARGUMENT, "texture_unit");
  refused([](auto& i) { i.texture_unit = 30; }, PLD_ERROR_ARGUMENT, "a unit that is not saved");
  refused(
      [](auto& i) {
        i.method = PLD_METHOD_FRONT_TAIL;
        i.features = PLD_FEATURE_REFRACTION;
      },
      PLD_ERROR_UNSUPPORTED, "front+tail refracts");
  refused([](auto& i) { i.features = PLD_FEATURE_DISPERSION; }, PLD_ERROR_UNSUPPORTED, "dispersion alone");
  refused(
      [](auto& i) {
        i.tier = PLD_TIER_PUBLISHED;
        i.method = PLD_METHOD_FRONT_TAIL;
      },
      PLD_ERROR_UNSUPPORTED, "published front+tail");
}

TEST(BridgeMisuse, NullPassesAreRefused) {
  uint64_t value = 0;
  const char* text = nullptr;
  pld_pass* none = nullptr;
  EXPECT_EQ(pld_resize(nullptr, 8, 8), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_begin(nullptr, PLD_STAGE_LAYERS, nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_end(nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_resolve(nullptr, nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_query(nullptr, PLD_VALUE_BYTES, &value), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_glsl(nullptr, PLD_STAGE_LAYERS, 330, &text), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_connect(nullptr, 1), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_destroy(nullptr), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_destroy(&none), PLD_ERROR_ARGUMENT);
  EXPECT_STREQ(pld_message(nullptr), "");
  EXPECT_STREQ(pld_status_name(static_cast<pld_status>(99)), "no pld_status");
  EXPECT_EQ(pld_version(), static_cast<uint32_t>(PLD_VERSION));
}

// Such a host saw no layer at all, and no error.
TEST(BridgeMisuse, AProjectionAgainstTheDepthsConventionIsRefused) {
  GlContext context;
  Host host(32, 24);
  pld_target target = host.target();
  pld_frame frame = host.frame();
  frame.depth_texture = makeTexture(GL_DEPTH_COMPONENT32F, 32, 24);
  for (const pld_depth depth : {PLD_DEPTH_DEVICE, PLD_DEPTH_REVERSED})
    for (const bool orthographic : {false, true})
      for (const uint32_t minor : {14, 15}) {
        pld_create_info info = host.info();
        info.depth = depth;
        info.version = PLD_VERSION_MAJOR << 20 | minor << 10;
        pld_pass* pass = nullptr;
        ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
        ASSERT_EQ(pld_resize(pass, 32, 24), PLD_OK);
        for (const float grows : {1.0f, -1.0f}) {
          std::fill(frame.projection, frame.projection + 16, 0.0f);
          frame.projection[0] = frame.projection[5] = 1.0f;
          frame.projection[10] = orthographic ? -0.01f * grows : 0.0f;
          frame.projection[11] = orthographic ? 0.0f : -1.0f;
          frame.projection[14] = orthographic ? 0.0f : -0.1f * grows;
          frame.projection[15] = orthographic ? 1.0f : 0.0f;
          const bool fits = (grows > 0.0f) == (depth == PLD_DEPTH_DEVICE);
          if (fits || minor == 14) {
            EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
            EXPECT_EQ(pld_end(pass), PLD_OK);
            continue;
          }
          expectRefused(pass, pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ARGUMENT, "depth that runs against");
          EXPECT_NE(std::string(pld_message(pass)).find("info.depth is PLD_DEPTH_"), std::string::npos);
          expectRefused(pass, pld_end(pass), PLD_ERROR_ORDER, "an end whose begin failed");
          EXPECT_NE(std::string(pld_message(pass)).find("the last pld_begin failed"), std::string::npos);
          EXPECT_EQ(pld_resolve(pass, &target), grows > 0.0f ? PLD_ERROR_ORDER : PLD_OK) << "of the frame before";
        }
        EXPECT_EQ(pld_destroy(&pass), PLD_OK);
        // The frame left is one whose depth falls.
        pld_recipe_info of = pld_recipe_info_init(PLD_DIALECT_GL, 450);
        of.depth = depth;
        of.version = info.version;
        pld_recipe* recipe = nullptr;
        ASSERT_EQ(pld_recipe_create(&of, &recipe), PLD_OK);
        EXPECT_EQ(pld_recipe_check(recipe, &frame, 32, 24, nullptr, 0),
                  depth == PLD_DEPTH_REVERSED || minor == 14 ? PLD_OK : PLD_ERROR_ARGUMENT);
        EXPECT_EQ(pld_recipe_destroy(&recipe), PLD_OK);
      }
  glDeleteTextures(1, &frame.depth_texture);
}

TEST(BridgeMisuse, WrongOrderAndWrongFramesAreRefused) {
  GlContext context;
  Host host(32, 24);
  pld_create_info info = host.info();
  info.method = PLD_METHOD_FRONT_TAIL;
  info.features = PLD_FEATURE_SOLIDS;
  pld_pass* pass = nullptr;
  ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
  const pld_frame good = host.frame();
  pld_target target = host.target();
  uint64_t value = 0;
  const char* text = nullptr;
  expectRefused(pass, pld_begin(pass, PLD_STAGE_SOLIDS, &good), PLD_ERROR_ORDER, "begin before resize");
  expectRefused(pass, pld_end(pass), PLD_ERROR_ORDER, "end before begin");
  expectRefused(pass, pld_resolve(pass, &target), PLD_ERROR_ORDER, "resolve before a frame");
  for (const int size : {0, -3, 1 << 24}) expectRefused(pass, pld_resize(pass, size, 8), PLD_ERROR_SIZE, "resize");
  ASSERT_EQ(pld_resize(pass, 32, 24), PLD_OK);
  expectRefused(pass, pld_begin(pass, PLD_STAGE_LAYERS, &good), PLD_ERROR_ORDER, "layers before solids");
  EXPECT_NE(std::string(pld_message(pass)).find("PLD_STAGE_LAYERS"), std::string::npos) << pld_message(pass);
  expectRefused(pass, pld_begin(pass, PLD_STAGE_FRONT, &good), PLD_ERROR_ORDER, "front before solids");
  expectRefused(pass, pld_begin(pass, static_cast<pld_stage>(7), &good), PLD_ERROR_ARGUMENT, "no stage");
  expectRefused(pass, pld_begin(pass, PLD_STAGE_SOLIDS, nullptr), PLD_ERROR_ARGUMENT, "null frame");
  expectRefused(pass, pld_query(pass, PLD_VALUE_BYTES, nullptr), PLD_ERROR_ARGUMENT, "null value");
  expectRefused(pass, pld_query(pass, static_cast<pld_value>(77), &value), PLD_ERROR_ARGUMENT, "no value");
  expectRefused(pass, pld_query(pass, PLD_VALUE_NS_RESOLVE, &value), PLD_ERROR_UNSUPPORTED, "no timers");
  expectRefused(pass, pld_glsl(pass, PLD_STAGE_LAYERS, 331, &text), PLD_ERROR_ARGUMENT, "no GLSL");
  expectRefused(pass, pld_glsl(pass, PLD_STAGE_LAYERS, 330, nullptr), PLD_ERROR_ARGUMENT, "null text");
  expectRefused(pass, pld_glsl(pass, static_cast<pld_stage>(-1), 330, &text), PLD_ERROR_ARGUMENT, "no stage");
  const auto refused = [&](auto change, pld_status expected, const char* what) {
    pld_frame frame = good;
    change(frame);
    expectRefused(pass, pld_begin(pass, PLD_STAGE_SOLIDS, &frame), expected, what);
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const GLuint small = makeTexture(GL_RGBA32F, 16, 16), byte = makeTexture(GL_R8, 32, 24),
               integer = makeTexture(GL_RGBA32UI, 32, 24);
  GLuint cube = 0, deleted = makeTexture(GL_RGBA32F, 32, 24), unborn = 0, samples = 0;
  glCreateTextures(GL_TEXTURE_CUBE_MAP, 1, &cube);
  glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &samples);
  glTextureStorage2DMultisample(samples, 4, GL_RGBA8, 32, 24, GL_TRUE);
  const GLuint gone = deleted;
  glDeleteTextures(1, &deleted);
  glGenTextures(1, &unborn);
  refused([](auto& f) { f.struct_size = 3; }, PLD_ERROR_VERSION, "frame.struct_size");
  refused([](auto& f) { f.width = 33; }, PLD_ERROR_SIZE, "too wide");
  refused([](auto& f) { f.height = 0; }, PLD_ERROR_SIZE, "no height");
  refused([](auto& f) { f.projection[5] = nan; }, PLD_ERROR_ARGUMENT, "NaN in the projection");
  refused([](auto& f) { f.projection[11] = 1.0f; }, PLD_ERROR_ARGUMENT, "a left-handed projection");
  refused([](auto& f) { f.projection[0] = 0.0f; }, PLD_ERROR_ARGUMENT, "no focal length");
  refused([](auto& f) { f.metres_per_unit = 0.0f; }, PLD_ERROR_ARGUMENT, "no unit");
  refused([](auto& f) { f.pre_exposure = -inf; }, PLD_ERROR_ARGUMENT, "pre_exposure");
  refused([](auto& f) { f.weight_near = f.weight_far; }, PLD_ERROR_ARGUMENT, "weight range");
  refused([](auto& f) { f.weight_exponent = nan; }, PLD_ERROR_ARGUMENT, "weight exponent");
  refused([](auto& f) { f.refract = static_cast<pld_refract>(12); }, PLD_ERROR_ARGUMENT, "refract");
  refused([](auto& f) { f.colour_texture = 0; }, PLD_ERROR_TEXTURE, "no colour");
  refused([](auto& f) { f.depth_texture = 4242; }, PLD_ERROR_TEXTURE, "unknown depth");
  refused([](auto& f) { f.depth_texture = f.colour_texture; }, PLD_ERROR_TEXTURE, "one texture for both");
  refused([&](auto& f) { f.colour_texture = gone; }, PLD_ERROR_TEXTURE, "deleted colour");
  refused([&](auto& f) { f.colour_texture = unborn; }, PLD_ERROR_TEXTURE, "a name without a texture");
  refused([&](auto& f) { f.colour_texture = cube; }, PLD_ERROR_TEXTURE, "a cube map");
  refused([&](auto& f) { f.colour_texture = samples; }, PLD_ERROR_TEXTURE, "a multisampled texture");
  refused([&](auto& f) { f.colour_texture = integer; }, PLD_ERROR_FORMAT, "integers");
  refused([&](auto& f) { f.depth_texture = byte; }, PLD_ERROR_FORMAT, "depth in bytes");
  refused([&](auto& f) { f.colour_texture = small; }, PLD_ERROR_SIZE, "small colour");
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_SOLIDS, &good), PLD_OK);
  expectRefused(pass, pld_resize(pass, 16, 16), PLD_ERROR_ORDER, "resize inside of a stage");
  expectRefused(pass, pld_begin(pass, PLD_STAGE_FRONT, &good), PLD_ERROR_ORDER, "begin twice");
  ASSERT_EQ(pld_end(pass), PLD_OK);
  expectRefused(pass, pld_end(pass), PLD_ERROR_ORDER, "end twice");
  expectRefused(pass, pld_begin(pass, PLD_STAGE_LAYERS, &good), PLD_ERROR_ORDER, "front left out");
  expectRefused(pass, pld_resolve(pass, &target), PLD_ERROR_ORDER, "resolve before the layers");
  for (const pld_stage stage : {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) {
    ASSERT_EQ(pld_begin(pass, stage, &good), PLD_OK) << pld_message(pass);
    ASSERT_EQ(pld_end(pass), PLD_OK);
  }
  expectRefused(pass, pld_resolve(pass, nullptr), PLD_ERROR_ARGUMENT, "null target");
  const auto refusedTarget = [&](auto change, pld_status expected, const char* what) {
    pld_target changed = target;
    change(changed);
    expectRefused(pass, pld_resolve(pass, &changed), expected, what);
  };
  uint64_t plane = 0;
  ASSERT_EQ(pld_query(pass, PLD_VALUE_FIRST_PLANE, &plane), PLD_OK);
  refusedTarget([](auto& t) { t.struct_size = 0; }, PLD_ERROR_VERSION, "target.struct_size");
  refusedTarget([](auto& t) { t.view = static_cast<pld_view>(40); }, PLD_ERROR_ARGUMENT, "view");
  refusedTarget([](auto& t) { t.view = PLD_VIEW_WEIGHT; }, PLD_ERROR_UNSUPPORTED, "views were not asked for");
  refusedTarget([](auto& t) { t.kind = static_cast<pld_target_kind>(3); }, PLD_ERROR_ARGUMENT, "kind");
  refusedTarget([&](auto& t) { t.name = gone; }, PLD_ERROR_TEXTURE, "deleted target");
  refusedTarget([&](auto& t) { t.name = small; }, PLD_ERROR_SIZE, "small target");
  refusedTarget([&](auto& t) { t.name = byte; }, PLD_ERROR_FORMAT, "target format");
  refusedTarget([&](auto& t) { t.name = host.colour; }, PLD_ERROR_TEXTURE, "target is the background");
  refusedTarget([&](auto& t) { t.name = static_cast<GLuint>(plane); }, PLD_ERROR_TEXTURE, "target is a plane");
  refusedTarget(
      [](auto& t) {
        t.kind = PLD_TARGET_FRAMEBUFFER;
        t.name = 999;
      },
      PLD_ERROR_TEXTURE, "no framebuffer");
  // After all that, a frame without layers is the background to the bit.
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(host.picture(), readTexture(host.colour, 32, 24, GL_RGBA));
  // A texture that vanishes between begin and resolve.
  for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) {
    ASSERT_EQ(pld_begin(pass, stage, &good), PLD_OK) << pld_message(pass);
    ASSERT_EQ(pld_end(pass), PLD_OK);
  }
  glDeleteTextures(1, &host.colour);
  expectRefused(pass, pld_resolve(pass, &target), PLD_ERROR_TEXTURE, "colour deleted meanwhile");
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  EXPECT_EQ(pass, nullptr);
}

TEST(BridgeMisuse, AnotherContextAndAnotherThreadAreRefused) {
  GlContext context;
  Host host(16, 16);
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext own = eglGetCurrentContext();
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  // A thread without a context.
  pld_status status = PLD_OK;
  std::string message;
  std::thread([&] {
    status = pld_begin(pass, PLD_STAGE_LAYERS, &frame);
    message = pld_message(pass);
  }).join();
  EXPECT_EQ(status, PLD_ERROR_CONTEXT);
  EXPECT_NE(message.find("not current"), std::string::npos) << message;
  {
    // A context that happens to have objects of the same names.
    GlContext another;
    Host other(16, 16);
    pld_pass* twin = other.create(other.info());
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_CONTEXT);
    EXPECT_EQ(pld_resize(pass, 4, 4), PLD_ERROR_CONTEXT);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const pld_frame theirs = other.frame();
    EXPECT_EQ(pld_begin(twin, PLD_STAGE_LAYERS, &theirs), PLD_OK);
    EXPECT_EQ(pld_end(twin), PLD_OK);
    EXPECT_EQ(pld_destroy(&twin), PLD_OK);
  }
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_CONTEXT);
  // The thread that takes the context over may go on.
  std::thread([&] {
    eglBindAPI(EGL_OPENGL_API);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own);
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
    EXPECT_EQ(pld_end(pass), PLD_OK);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }).join();
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own);
  const pld_target target = host.target();
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  // Without its context a pass gives back its memory all the same.
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  EXPECT_EQ(pld_destroy(&pass), PLD_ERROR_CONTEXT);
  EXPECT_EQ(pass, nullptr);
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own);
}

// A log callback that calls back into the pass meets PLD_ERROR_BUSY, not a deadlock; so does a second thread.
TEST(BridgeMisuse, ACallWithinACallIsRefused) {
  GlContext context;
  Host host(16, 16);
  struct Nested {
    pld_pass* pass = nullptr;
    pld_status status = PLD_OK;
  } nested;
  pld_create_info info = host.info();
  info.log_user = &nested;
  info.log = [](void* user, pld_log_level, const char*) {
    auto* self = static_cast<Nested*>(user);
    if (self->pass) self->status = pld_end(self->pass);
  };
  pld_pass* pass = nullptr;
  ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
  nested.pass = pass;
  EXPECT_EQ(pld_end(pass), PLD_ERROR_ORDER);
  EXPECT_EQ(nested.status, PLD_ERROR_BUSY);
  nested.pass = nullptr;
  pld_destroy(&pass);
}

// The host's own GL errors are the host's.
TEST(BridgeMisuse, PendingErrorsOfTheHostStayPending) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  glEnable(0xdead);
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  const pld_target target = host.target();
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_INVALID_ENUM));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
