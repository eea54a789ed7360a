// After pld_resize(): no GL object is made, none destroyed, and the library asks for no memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <new>
#include <string>

#include "tests/bridge/host.h"
#include "tests/bridge/shadow_casters.h"
// After epoxy, which declares the same.
#include "engine_bridge/c/gl_functions.h"

namespace {

// Counting: only inside of a call of the library, and not inside of the driver that it calls.
thread_local bool inLibrary = false;
thread_local int inDriver = 0;
std::size_t allocations = 0;
std::map<std::string, int> calls;

}  // namespace

// Under a sanitizer memory is its own; operator new says enough there.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* malloc(std::size_t size) {
  if (inLibrary && inDriver == 0) ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  if (inLibrary && inDriver == 0) ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  if (inLibrary && inDriver == 0) ++allocations;
  return __libc_realloc(memory, size);
}
}
#endif

namespace pellucid::test {
namespace {

// A function of GL that is counted and marks the driver's memory as the driver's.
template <int place, class F>
struct Counted;
template <int place, class R, class... A>
struct Counted<place, R (*)(A...)> {
  static inline R (*real)(A...) = nullptr;
  static inline const char* name = nullptr;
  static R call(A... a) {
    struct Inside {
      Inside() { ++inDriver; }
      ~Inside() { --inDriver; }
    } inside;
    ++calls[name];
    return real(a...);
  }
};

pld_proc counted(void*, const char* wanted) {
  const std::string name = wanted;
  const pld_proc real = procAddress(nullptr, wanted);
  if (!real) return nullptr;
#define PLD_COUNT(function, type)                  \
  if (name == "gl" #function) {                    \
    using One = Counted<__COUNTER__, type>;        \
    One::real = reinterpret_cast<type>(real);      \
    One::name = "gl" #function;                    \
    return reinterpret_cast<pld_proc>(&One::call); \
  }
  PLD_GL_REQUIRED(PLD_COUNT)
  PLD_GL_OPTIONAL(PLD_COUNT)
#undef PLD_COUNT
  return real;
}

template <class F>
pld_status inside(F f) {
  inLibrary = true;
  const pld_status status = f();
  inLibrary = false;
  return status;
}

bool makes(const std::string& name) {
  for (const char* kind : {"glGen", "glCreate", "glDelete", "glTexImage", "glTexStorage", "glBufferData",
                           "glCompileShader", "glLinkProgram", "glShaderSource"})
    if (name.rfind(kind, 0) == 0) return true;
  return false;
}

constexpr uint32_t kTold = PLD_FEATURE_DEPTHS | PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;

TEST(BridgeSteady, NothingIsAllocatedAndNoObjectIsMadeAfterResize) {
  struct Kind {
    const char* what;
    pld_method method;
    pld_tier tier;
    uint32_t features;
    std::vector<pld_stage> stages;
  };
  const Kind kinds[] = {
      {"float, all phenomena",
       PLD_METHOD_PHENOMENOLOGICAL,
       PLD_TIER_FLOAT,
       PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
           PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
       {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}},
      {"half, front+tail",
       PLD_METHOD_FRONT_TAIL,
       PLD_TIER_HALF,
       PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
       {PLD_STAGE_FRONT, PLD_STAGE_LAYERS, PLD_STAGE_LOW}},
      {"published", PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED, PLD_FEATURE_REFRACTION, {PLD_STAGE_LAYERS}},
      {"exact, all phenomena",
       PLD_METHOD_PHENOMENOLOGICAL,
       PLD_TIER_EXACT,
       PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
           PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION,
       {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW}},
      {"exact, front+tail", PLD_METHOD_FRONT_TAIL, PLD_TIER_EXACT, 0, {PLD_STAGE_LAYERS}},
      {"exact, over", PLD_METHOD_OVER, PLD_TIER_EXACT, PLD_FEATURE_OUTPUTS, {PLD_STAGE_LAYERS}},
      {"float, told",
       PLD_METHOD_WEIGHTED,
       PLD_TIER_FLOAT,
       kTold | PLD_FEATURE_SOLIDS,
       {PLD_STAGE_SOLIDS, PLD_STAGE_FRONT, PLD_STAGE_LAYERS}},
      {"exact, told",
       PLD_METHOD_WEIGHTED,
       PLD_TIER_EXACT,
       kTold | PLD_FEATURE_SOLIDS,
       {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}}};
  GlContext context;
  Host host(48, 32);
  for (const Kind& kind : kinds) {
    pld_create_info info = host.info();
    info.get_proc_address = counted;
    info.log = [](void* user, pld_log_level level, const char* text) {
      ++inDriver;  // the host's memory, not the library's
      Log::add(user, level, text);
      --inDriver;
    };
    info.method = kind.method;
    info.tier = kind.tier;
    info.fragments_per_pixel = 4.0f;
    info.features = kind.features;
    info.flags = PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS | PLD_FLAG_DEBUG_VIEWS;
    calls.clear();
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    const pld_shadow_info maps =
        shadowInfo(kind.tier == PLD_TIER_HALF ? PLD_SHADOW_NAIVE : PLD_SHADOW_VARIANCE, 32, 1, 1, kind.features != 0);
    ASSERT_EQ(pld_shadow_resize(pass, &maps), PLD_OK) << pld_message(pass);
    int made = 0, total = 0;
    for (const auto& [name, count] : calls) made += makes(name) ? count : 0;
    EXPECT_GT(made, 10);  // the counter counts
    calls.clear();
    allocations = 0;
    const pld_target target = host.target();
    std::vector<pld_view> views{PLD_VIEW_WEIGHT, PLD_VIEW_SHADOW_TRANSMISSION, PLD_VIEW_SHADOW_DEPTH};
    if (std::count(kind.stages.begin(), kind.stages.end(), PLD_STAGE_RIMS)) views.push_back(PLD_VIEW_RIM_LOSS);
    if (kind.features & PLD_FEATURE_LOW_RESOLUTION) views.push_back(PLD_VIEW_LOW_COLOUR);
    if (kind.features & kTold) views.insert(views.end(), {PLD_VIEW_MEAN_DEPTH, PLD_VIEW_MOTION, PLD_VIEW_IDENTITY});
    uint64_t value = 0;
    for (int number = 0; number < 20; ++number) {
      pld_frame frame = host.frame();
      frame.width = 48 - 2 * number;  // the size of a frame may change
      const pld_shadow_view shadow = plainShadowView();
      ASSERT_EQ(inside([&] { return pld_shadow_begin(pass, &shadow); }), PLD_OK) << pld_message(pass);
      ASSERT_EQ(inside([&] { return pld_shadow_end(pass); }), PLD_OK);
      ASSERT_EQ(inside([&] { return pld_shadow_resize(pass, &maps); }), PLD_OK);  // to what it is
      for (const pld_stage stage : kind.stages) {
        ASSERT_EQ(inside([&] { return pld_begin(pass, stage, &frame); }), PLD_OK) << pld_message(pass);
        ASSERT_EQ(inside([&] { return pld_end(pass); }), PLD_OK);
      }
      ASSERT_EQ(inside([&] { return pld_resolve(pass, &target); }), PLD_OK) << pld_message(pass);
      for (const pld_view one : views) {
        pld_target view = target;
        view.view = one;
        ASSERT_EQ(inside([&] { return pld_resolve(pass, &view); }), PLD_OK) << pld_message(pass);
      }
      inside([&] { return pld_query(pass, PLD_VALUE_NS_RESOLVE, &value); });
      frame.depth_texture = 77777;
      EXPECT_EQ(inside([&] { return pld_begin(pass, kind.stages[0], &frame); }), PLD_ERROR_TEXTURE);
      host.log.lines.clear();
    }
    std::string which;
    made = 0;
    for (const auto& [name, count] : calls) {
      total += count;
      if (makes(name)) made += count, which += name + " ";
    }
    std::printf("steady state, %s: 20 frames, %d GL calls, %d objects made or resized, %zu allocations\n", kind.what,
                total, made, allocations);
    EXPECT_EQ(made, 0) << which;
    EXPECT_EQ(allocations, 0u);
    EXPECT_GT(total, 1000);
    pld_destroy(&pass);
  }
}

// With PLD_FLAG_TRUST_TEXTURES the first frame is looked at, and no later one; pld_resize() has the next looked at
// again.
TEST(BridgeSteady, ATrustedHostIsAskedNothing) {
  GlContext context;
  Host host(48, 32);
  pld_create_info info = host.info();
  info.get_proc_address = counted;
  info.features =
      PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION | PLD_FEATURE_SOLIDS;
  info.flags = PLD_FLAG_HOST_RESTORES | PLD_FLAG_TRUST_TEXTURES;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  const pld_target target = host.target();
  const auto draw = [&] {
    for (const pld_stage stage : {PLD_STAGE_SOLIDS, PLD_STAGE_LAYERS}) {
      ASSERT_EQ(inside([&] { return pld_begin(pass, stage, &frame); }), PLD_OK) << pld_message(pass);
      ASSERT_EQ(inside([&] { return pld_end(pass); }), PLD_OK) << pld_message(pass);
    }
    ASSERT_EQ(inside([&] { return pld_resolve(pass, &target); }), PLD_OK) << pld_message(pass);
  };
  const auto asked = [&] {
    std::string names;
    for (const auto& [name, count] : calls)
      if (count > 0 && (name.rfind("glGet", 0) == 0 || name.rfind("glIs", 0) == 0 || name.rfind("glCheck", 0) == 0))
        names += name + " ";
    return names;
  };
  calls.clear();
  draw();
  EXPECT_NE(asked(), "") << "the counter counts";
  calls.clear();
  draw();
  int total = 0;
  for (const auto& [name, count] : calls) total += count;
  std::printf("a trusted host that restores: %d GL calls a frame of two stages, asked: %s\n", total,
              asked().empty() ? "nothing" : asked().c_str());
  EXPECT_EQ(asked(), "");
  EXPECT_LE(total, 250);
  ASSERT_EQ(pld_resize(pass, 48, 32), PLD_OK);
  frame.depth_texture = 77777;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_SOLIDS, &frame), PLD_ERROR_TEXTURE);
  pld_destroy(&pass);
}

// A timestamp after each draw of the library's and at the end of each stage keeps llvmpipe's fences; elsewhere there is
// none.
TEST(BridgeSteady, DrawsKeepTheirFencesOnLlvmpipe) {
  GlContext context;
  const bool llvmpipe = context.description().find("llvmpipe") != std::string::npos;
  Host host(16, 16);
  pld_create_info info = host.info();
  info.get_proc_address = counted;
  info.features = PLD_FEATURE_RIMS | PLD_FEATURE_LOW_RESOLUTION;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  const pld_target target = host.target();
  calls.clear();
  const std::vector<pld_stage> stages{PLD_STAGE_LAYERS, PLD_STAGE_RIMS, PLD_STAGE_LOW};
  for (const pld_stage stage : stages) {
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    ASSERT_EQ(pld_end(pass), PLD_OK);
  }
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  const int draws = calls["glDrawArrays"];
  EXPECT_GT(draws, 3);
  EXPECT_EQ(calls["glQueryCounter"], llvmpipe ? draws + static_cast<int>(stages.size()) : 0);
  pld_destroy(&pass);
}

// The counter sees an allocation that a call does make.
TEST(BridgeSteady, TheCounterSeesAllocations) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  allocations = 0;
  const char* seam = nullptr;
  EXPECT_EQ(inside([&] { return pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam); }), PLD_OK);
  EXPECT_GT(allocations, 0u);
  pld_destroy(&pass);
#endif
}

}  // namespace
}  // namespace pellucid::test
