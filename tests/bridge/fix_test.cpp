// What a host fixes for all frames: constants in the seam's text give the bits that the block gives, and frames keep to
// them.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "tests/bridge/host.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr uint32_t kEverything = PLD_FIXED_UNITS | PLD_FIXED_EXPOSURE | PLD_FIXED_WEIGHT | PLD_FIXED_REFRACTION |
                                 PLD_FIXED_DIFFUSION | PLD_FIXED_PROJECTION | PLD_FIXED_LENS;

// Six tilted panes that fill the picture, one vertex shader run for each of their corners.
const char* const kVertex = R"(
uniform mat4 clipFromView;
out vec3 viewPosition;
flat out int pane;
void main() {
  pane = gl_VertexID / 3;
  vec2 corner = vec2(gl_VertexID % 3 == 1 ? 3.0 : -1.0, gl_VertexID % 3 == 2 ? 3.0 : -1.0);
  float z = 3.0 + 1.7 * float(pane) + 0.9 * corner.x;
  viewPosition = vec3(corner * 4.0 * z, -z);
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";
const char* const kFragment = R"(
in vec3 viewPosition;
flat in int pane;
void main() {
  vec3 tint = vec3(0.3 + 0.1 * float(pane), 0.9, 0.7 - 0.1 * float(pane));
  PldSurface surface = pldSurface(0.2 * tint, 0.45, 0.8 * tint, viewPosition);
  surface.normal = normalize(vec3(0.2 * sin(viewPosition.x * 3.0), 0.2, 1.0));
  surface.eta = 1.0 / 1.5;
  surface.etaRedBlue = vec2(1.0 / 1.48, 1.0 / 1.52);
  surface.thickness = 0.05;
  surface.collimation = 0.8;
  pldWriteFragment(surface);
}
)";

struct Case {
  const char* what;
  pld_method method;
  pld_weight weight;
  uint32_t features;
  pld_refract refract;
  bool orthographic;
  pld_tier tier = PLD_TIER_FLOAT;
};

std::vector<float> drawn(const Case& one, uint32_t fixed) {
  Host host(kWidth, kHeight);
  pld_create_info info = host.info();
  info.method = one.method;
  info.weight = one.weight;
  info.features = one.features;
  info.tier = one.tier;
  info.fragments_per_pixel = 6.0f;
  pld_frame frame = host.frame();
  frame.metres_per_unit = 0.37f;
  frame.pre_exposure = 1.3f;
  frame.weight_exponent = 2.0907593f;
  frame.weight_reference = 0.71f;
  frame.weight_near = 0.123f;
  frame.weight_far = 77.7f;
  frame.refract = one.refract;
  if (one.orthographic) {
    frame.projection[0] = 0.06f;
    frame.projection[5] = 0.09f;
    frame.projection[10] = -0.01f;
    frame.projection[11] = frame.projection[14] = 0.0f;
    frame.projection[15] = 1.0f;
  }
  pld_pass* pass = host.create(info);
  if (!pass) return {};
  EXPECT_EQ(pld_fix(pass, &frame, fixed), PLD_OK) << pld_message(pass);
  for (const pld_stage stage : {PLD_STAGE_FRONT, PLD_STAGE_LAYERS}) {
    if (stage == PLD_STAGE_FRONT && one.method != PLD_METHOD_FRONT_TAIL) continue;
    const char* seam = nullptr;
    EXPECT_EQ(pld_glsl(pass, stage, 450, &seam), PLD_OK);
    const std::string first = "#version 450 core\n";
    const GLuint program = makeProgram(first + kVertex, first + (seam ? seam : "") + kFragment);
    EXPECT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    GLuint array = 0;
    glCreateVertexArrays(1, &array);
    glBindVertexArray(array);
    glUseProgram(program);
    glProgramUniformMatrix4fv(program, glGetUniformLocation(program, "clipFromView"), 1, GL_FALSE, frame.projection);
    glDrawArrays(GL_TRIANGLES, 0, 18);
    EXPECT_EQ(pld_end(pass), PLD_OK);
    glBindVertexArray(0);
    glUseProgram(0);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
  }
  return host.finish(pass);
}

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t words = 0;
  for (std::size_t i = 0; i < a.size(); ++i) words += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
  return words;
}

TEST(BridgeFix, ConstantsGiveTheBitsOfTheBlock) {
  GlContext context;
  constexpr uint32_t all = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION |
                           PLD_FEATURE_DISPERSION;
  const Case cases[] = {
      {"at depth", PLD_METHOD_PHENOMENOLOGICAL, PLD_WEIGHT_BY_EQ5, all, PLD_REFRACT_AT_DEPTH, false},
      {"at a distance", PLD_METHOD_PHENOMENOLOGICAL, PLD_WEIGHT_BY_EQ10Z, all, PLD_REFRACT_AT_DISTANCE, false},
      {"slab, orthographic", PLD_METHOD_PHENOMENOLOGICAL, PLD_WEIGHT_BY_POWER, all, PLD_REFRACT_THROUGH_SLAB, true},
      {"not refracted", PLD_METHOD_PHENOMENOLOGICAL, PLD_WEIGHT_BY_EQ7, all, PLD_REFRACT_NOTHING, false},
      {"weighted", PLD_METHOD_WEIGHTED, PLD_WEIGHT_BY_POWER, 0, PLD_REFRACT_NOTHING, false},
      {"front+tail", PLD_METHOD_FRONT_TAIL, PLD_WEIGHT_BY_POWER, 0, PLD_REFRACT_NOTHING, false},
      {"exact tier", PLD_METHOD_PHENOMENOLOGICAL, PLD_WEIGHT_BY_EQ7Z, all, PLD_REFRACT_AT_DISTANCE, true,
       PLD_TIER_EXACT}};
  std::vector<float> last;
  for (const Case& one : cases) {
    const std::vector<float> read = drawn(one, 0), constant = drawn(one, kEverything);
    ASSERT_EQ(read.size(), constant.size());
    const std::size_t words = differing(read, constant);
    std::printf("fixed against read from the block, %s: %zu of %zu words differ\n", one.what, words, read.size());
    EXPECT_EQ(words, 0u) << one.what;
    if (!last.empty()) {
      EXPECT_GT(differing(read, last), read.size() / 8) << one.what << " draws what the last case drew";
    }
    last = read;
  }
}

TEST(BridgeFix, FramesKeepToWhatIsFixed) {
  GlContext context;
  Host host(32, 24);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame good = host.frame();
  const auto refused = [&](auto change, uint32_t fields, pld_status expected, const char* word) {
    pld_frame frame = good;
    change(frame);
    EXPECT_EQ(pld_fix(pass, &frame, fields), expected) << word;
    EXPECT_NE(std::string(pld_message(pass)).find(word), std::string::npos) << pld_message(pass);
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pld_fix(nullptr, &good, 0), PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_fix(pass, nullptr, 0), PLD_ERROR_ARGUMENT);
  refused([](auto& f) { f.struct_size = 3; }, 0, PLD_ERROR_VERSION, "struct_size");
  refused([](auto&) {}, 128, PLD_ERROR_ARGUMENT, "fields");
  refused([](auto& f) { f.metres_per_unit = 0; }, PLD_FIXED_UNITS, PLD_ERROR_ARGUMENT, "metres_per_unit");
  refused([](auto& f) { f.pre_exposure = -1; }, PLD_FIXED_EXPOSURE, PLD_ERROR_ARGUMENT, "pre_exposure");
  refused([](auto& f) { f.weight_exponent = nan; }, PLD_FIXED_WEIGHT, PLD_ERROR_ARGUMENT, "exponent");
  refused([](auto& f) { f.refract = static_cast<pld_refract>(9); }, PLD_FIXED_REFRACTION, PLD_ERROR_ARGUMENT,
          "refract");
  refused([](auto& f) { f.diffusion_k1 = 0; }, PLD_FIXED_DIFFUSION, PLD_ERROR_ARGUMENT, "diffusion_k1");
  refused([](auto& f) { f.projection[11] = 3; }, PLD_FIXED_PROJECTION, PLD_ERROR_ARGUMENT, "projection");
  refused([](auto& f) { f.projection[0] = 0; }, PLD_FIXED_LENS, PLD_ERROR_ARGUMENT, "projection");
  refused([](auto& f) { f.width = 0; }, PLD_FIXED_LENS, PLD_ERROR_SIZE, "0x24");
  refused([](auto& f) { f.projection[11] = 0, f.projection[15] = 1, f.metres_per_unit = 0; }, PLD_FIXED_LENS,
          PLD_ERROR_ARGUMENT, "metres_per_unit");
  pld_frame nonsense = good;  // of what is not named nothing is read
  nonsense.metres_per_unit = nonsense.diffusion_k1 = nan;
  EXPECT_EQ(pld_fix(pass, &nonsense, PLD_FIXED_WEIGHT), PLD_OK) << pld_message(pass);
  ASSERT_EQ(pld_fix(pass, &good, kEverything & ~static_cast<uint32_t>(PLD_FIXED_EXPOSURE | PLD_FIXED_LENS)), PLD_OK)
      << pld_message(pass);
  const char* seam = nullptr;
  ASSERT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK);
  EXPECT_EQ(pld_fix(pass, &good, 0), PLD_ERROR_ORDER);
  const auto begins = [&](auto change, pld_status expected, const char* word) {
    pld_frame frame = good;
    change(frame);
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), expected) << word;
    EXPECT_NE(std::string(pld_message(pass)).find(word), std::string::npos) << pld_message(pass);
    if (expected == PLD_OK) {
      EXPECT_EQ(pld_end(pass), PLD_OK);
    }
  };
  begins([](auto& f) { f.metres_per_unit = 2; }, PLD_ERROR_ARGUMENT, "metres_per_unit");
  begins([](auto& f) { f.weight_near = 0.2f; }, PLD_ERROR_ARGUMENT, "weight_near");
  begins([](auto& f) { f.weight_far = 50; }, PLD_ERROR_ARGUMENT, "weight_far");
  begins([](auto& f) { f.weight_exponent = 2; }, PLD_ERROR_ARGUMENT, "weight_exponent");
  begins([](auto& f) { f.weight_reference = 2; }, PLD_ERROR_ARGUMENT, "weight_reference");
  begins([](auto& f) { f.refract = PLD_REFRACT_NOTHING; }, PLD_ERROR_ARGUMENT, "refract");
  begins([](auto& f) { f.refract_distance = 1; }, PLD_ERROR_ARGUMENT, "refract_distance");
  begins([](auto& f) { f.diffusion_k0 = 0.1f; }, PLD_ERROR_ARGUMENT, "diffusion_k0");
  begins([](auto& f) { f.diffusion_k1 = 0.1f; }, PLD_ERROR_ARGUMENT, "diffusion_k1");
  begins([](auto& f) { f.projection[11] = 0, f.projection[15] = 1; }, PLD_ERROR_ARGUMENT, "projection");
  begins([](auto& f) { f.projection[0] *= 2, f.pre_exposure = 3; }, PLD_OK, "");
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

// A host may speak a language that writes commas; GLSL does not.
TEST(BridgeFix, ConstantsAreWrittenAlikeInEveryLocale) {
  GlContext context;
  const char* there = nullptr;
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "nl_NL.UTF-8"})
    if (!there) there = std::setlocale(LC_ALL, name);
  std::printf("locale: %s\n", there ? there : "only C is installed");
  Host host(32, 24);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  const pld_frame frame = host.frame();
  EXPECT_EQ(pld_fix(pass, &frame, PLD_FIXED_EXPOSURE), PLD_OK);
  const char* seam = nullptr;
  EXPECT_EQ(pld_glsl(pass, PLD_STAGE_LAYERS, 450, &seam), PLD_OK);
  std::setlocale(LC_ALL, "C");
  ASSERT_NE(seam, nullptr);
  EXPECT_NE(std::string(seam).find("EXPOSURE (1.00000000e+00f)"), std::string::npos);
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

TEST(BridgeFix, TheLensIsFocalLengthsInPixels) {
  GlContext context;
  Host host(32, 24);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_REFRACTION;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame good = host.frame();
  ASSERT_EQ(pld_fix(pass, &good, PLD_FIXED_LENS), PLD_OK) << pld_message(pass);
  const auto begins = [&](auto change, pld_status expected) {
    pld_frame frame = good;
    change(frame);
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), expected) << pld_message(pass);
    if (expected == PLD_OK) {
      EXPECT_EQ(pld_end(pass), PLD_OK);
    }
  };
  begins([](auto& f) { f.projection[0] *= 2; }, PLD_ERROR_ARGUMENT);
  begins([](auto& f) { f.projection[5] *= 0.5f; }, PLD_ERROR_ARGUMENT);
  begins([](auto& f) { f.width /= 2; }, PLD_ERROR_ARGUMENT);
  begins([](auto& f) { f.width /= 2, f.projection[0] *= 2; }, PLD_OK);
  begins([](auto& f) { f.projection[5] *= -1, f.projection[8] = 0.01f, f.metres_per_unit = 2; }, PLD_OK);
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
}

// A header of 0.2 knows no pld_fix(): its hosts are taken as before.
TEST(BridgeFix, HostsOfEarlierVersionsAreTaken) {
  GlContext context;
  Host host(32, 24);
  for (const uint32_t minor : {0u, 1u, 2u, 3u}) {
    pld_create_info info = host.info();
    info.version = minor << 10;
    info.struct_size = offsetof(pld_create_info, fragments_per_pixel);  // where it ended
    info.fragments_per_pixel = std::numeric_limits<float>::quiet_NaN();
    pld_pass* pass = nullptr;
    EXPECT_EQ(pld_create(&info, &pass), PLD_OK) << minor;
    EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  }
}

}  // namespace
}  // namespace pellucid::test
