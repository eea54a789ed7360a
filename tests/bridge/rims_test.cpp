// Rims of leaves through the C library against the rooms: the light from around apart, darkened by the opaque pixels beside.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>

#include "composite/fold.h"
#include "composite/methods/method.h"
#include "composite/resolve.h"
#include "composite/rims.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 90, kHeight = 70, kLayers = 5;
constexpr shading::WeightSettings kWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f};

// Leaves before a wall and before each other: five fragments in a pixel, most of them rims.
struct Leaves {
  GBuffer gbuffer;
  FragmentLists lists;
  OccluderPlanes occluders;
  RimPlanes rims{kWidth, kHeight};
  Image<glm::vec4> look[kLayers], around[kLayers], gradient[kLayers];  // radiance, coverage; around, z; gradient

  explicit Leaves(bool solids) {
    Random random(11);
    gbuffer.display = gbuffer.data = lists.window = occluders.data = {0, 0, kWidth, kHeight};
    gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
    gbuffer.viewZ = occluders.viewZ = occluders.occlusion = Image<float>(kWidth, kHeight);
    lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, INFINITY));
    for (int i = 0; i < kLayers; ++i) look[i] = around[i] = gradient[i] = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0.0f));
    lists.offsets.push_back(0);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        gbuffer.beauty.at(x, y) = glm::vec4(random.uniformf(), random.uniformf(), .3f, 1.0f);
        gbuffer.viewZ.at(x, y) = (x / 8 + y / 11) % 3 == 0 ? INFINITY : 3.0f + .05f * random.uniformf();
        occluders.occlusion.at(x, y) = random.below(20) == 0 ? NAN : random.uniformf();
        std::vector<Fragment> seen;
        for (int i = 0; i < kLayers; ++i) {
          if (random.below(3) == 0) continue;
          Fragment one{};
          one.coverage = solids && random.below(6) == 0 ? 1.0f : .9f * random.uniformf() + .05f;
          one.radiance = one.coverage * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
          one.z = 2.9f + .3f * random.uniformf();
          const glm::vec2 slope = random.below(5) == 0 ? glm::vec2(0) : glm::vec2(random.uniformf() - .5f, random.uniformf() - .5f);
          look[i].at(x, y) = glm::vec4(one.radiance, one.coverage);
          around[i].at(x, y) = glm::vec4(.75f * one.radiance, one.z);
          gradient[i].at(x, y) = glm::vec4(slope, 0, 0);
          glm::vec4& solid = lists.solid.at(x, y);
          if (one.coverage == 1.0f && one.z < solid.a && one.z <= gbuffer.viewZ.at(x, y)) solid = glm::vec4(one.radiance, one.z);
          seen.push_back(one);
        }
        occluders.viewZ.at(x, y) = std::min(gbuffer.viewZ.at(x, y), lists.solid.at(x, y).a);
        std::size_t next = 0;
        for (int i = 0; i < kLayers; ++i) {
          if (look[i].at(x, y).a == 0.0f) continue;
          const Fragment one = seen[next++];
          if (one.z > gbuffer.viewZ.at(x, y) || (one.coverage < 1.0f && one.z > lists.solid.at(x, y).a)) continue;
          lists.fragments.push_back(one);
          if (one.coverage == 1.0f) continue;
          shading::Layer part{glm::vec3(around[i].at(x, y)), one.coverage, one.transmission, one.z};
          const shading::OitSums sums = shading::layerSums(part, kWeight, shading::PLD_NORMALISE_SPECTRAL);
          const float k = one.coverage * shading::depthWeight(kWeight, one.z);
          rims.averaged.at(x, y) += glm::vec4(sums.numerator, k);
          rims.added.at(x, y) += glm::vec4(sums.light, k * one.z);
          rims.gradient.at(x, y) += k * glm::vec2(gradient[i].at(x, y));
        }
        lists.offsets.push_back(lists.fragments.size());
      }
  }
};

const char* const kMain = R"(
uniform sampler2D look, around, slope;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(look, at, 0), b = texelFetch(around, at, 0);
  if (a.a == 0.0) discard;
  pldWriteRim(pldSurface(a.rgb, a.a, vec3(0.0), vec3(0.0, 0.0, -b.a)), b.rgb, texelFetch(slope, at, 0).rg);
}
)";

std::vector<float> bridged(const Leaves& leaves, uint32_t features, pld_occlusion form, int version) {
  Host host(kWidth, kHeight);
  host.upload(leaves.gbuffer);
  const GLuint open = makeTexture(GL_R32F, kWidth, kHeight);
  fillTexture(open, kWidth, kHeight, GL_RED, &leaves.occluders.occlusion.at(0, 0));
  pld_create_info info = host.info();
  info.features = features | PLD_FEATURE_RIMS;
  pld_pass* pass = host.create(info);
  if (!pass) return {};
  pld_frame frame = host.frame();
  frame.occlusion_texture = open;
  frame.occlusion = form;
  GLuint array = 0, textures[3];
  glCreateVertexArrays(1, &array);
  for (GLuint& one : textures) one = makeTexture(GL_RGBA32F, kWidth, kHeight);
  std::vector<pld_stage> stages{PLD_STAGE_LAYERS, PLD_STAGE_RIMS};
  if (features & PLD_FEATURE_SOLIDS) stages.insert(stages.begin(), PLD_STAGE_SOLIDS);
  for (const pld_stage stage : stages) {
    const char* seam = nullptr;
    EXPECT_EQ(pld_glsl(pass, stage, version, &seam), PLD_OK) << pld_message(pass);
    const GLuint program = makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + seam + kMain);
    EXPECT_EQ(pld_connect(pass, program), PLD_OK);
    EXPECT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    glUseProgram(program);
    glBindVertexArray(array);
    const char* names[] = {"look", "around", "slope"};
    for (GLint i = 0; i < 3; ++i) {
      glUniform1i(glGetUniformLocation(program, names[i]), 10 + i);
      glBindTextureUnit(static_cast<GLuint>(10 + i), textures[i]);
    }
    for (int layer = 0; layer < kLayers; ++layer) {
      fillTexture(textures[0], kWidth, kHeight, GL_RGBA, &leaves.look[layer].at(0, 0).x);
      fillTexture(textures[1], kWidth, kHeight, GL_RGBA, &leaves.around[layer].at(0, 0).x);
      fillTexture(textures[2], kWidth, kHeight, GL_RGBA, &leaves.gradient[layer].at(0, 0).x);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    EXPECT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    glDeleteProgram(program);
  }
  return host.finish(pass);
}

TEST(BridgeRims, OcclusionAtRimsIsThatOfTheRooms) {
  GlContext context;
  struct Case {
    const char* what;
    uint32_t features;
    pld_occlusion form;
    int version;
  };
  for (const Case& one : {Case{"coloured, light", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_RELATIVE, 450},
                          Case{"coloured, light, published form", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_PUBLISHED, 450},
                          Case{"GLSL 3.30", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_RELATIVE, 330},
                          Case{"coloured, light, solids", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_SOLIDS, PLD_OCCLUSION_RELATIVE, 450},
                          Case{"grey, without light", 0, PLD_OCCLUSION_RELATIVE, 450},
                          Case{"grey, light, diffusion", PLD_FEATURE_LIGHT | PLD_FEATURE_DIFFUSION, PLD_OCCLUSION_RELATIVE, 450}}) {
    const Leaves leaves((one.features & PLD_FEATURE_SOLIDS) != 0);
    OitPlanes planes = emptyPlanes(leaves.gbuffer.display, leaves.gbuffer.data);
    planes.info.weight = kWeight;
    foldFragments(leaves.lists, kWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
    const Image<glm::vec4> open = compose(resolveOver(planes, {}, {}, leaves.gbuffer), leaves.gbuffer).rgba;
    const std::size_t rims = occludeRims(leaves.rims, leaves.occluders, static_cast<int>(one.form), planes);
    const Image<glm::vec4> expected = compose(resolveOver(planes, {}, {}, leaves.gbuffer), leaves.gbuffer).rgba;
    const std::vector<float> found = bridged(leaves, one.features, one.form, one.version);
    ASSERT_EQ(found.size(), 4 * expected.size());
    std::size_t words = 0;
    double worst = 0, darkened = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const float value = expected[i / 4][static_cast<int>(i % 4)];
      words += std::memcmp(&value, &found[i], sizeof(value)) != 0;
      worst = std::max(worst, std::abs(static_cast<double>(value) - static_cast<double>(found[i])));
      darkened = std::max(darkened, static_cast<double>(open[i / 4][static_cast<int>(i % 4)]) - static_cast<double>(value));
    }
    std::printf("rims, %s: %zu pixels with rims, darkened by up to %.2f; %zu of %zu words differ from the rooms', by at most %.2g\n", one.what,
                rims, darkened, words, found.size(), worst);
    EXPECT_GT(rims, 3000u);
    EXPECT_GT(darkened, .2);
    if (one.version >= 400)
      EXPECT_EQ(words, 0u);
    else
      EXPECT_LT(worst, 5e-7);  // GLSL 3.30 has no `precise`
  }
}

// A host that was built against the first header has no occlusion_texture to give.
TEST(BridgeRims, FramesOfTheFirstHeaderStillWork) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  frame.struct_size = offsetof(pld_frame, occlusion_texture);
  frame.occlusion_texture = 0xdeadbeef;
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  pld_destroy(&pass);
  pld_create_info info = host.info();
  info.version = 1u << 10;  // 0.1
  ASSERT_EQ(pld_create(&info, &pass), PLD_OK);
  pld_destroy(&pass);
}

TEST(BridgeRims, WrongOcclusionIsRefused) {
  GlContext context;
  Host host(16, 16);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_RIMS;
  pld_pass* pass = nullptr;
  for (const bool fronts : {false, true}) {
    pld_create_info wrong = info;
    fronts ? void(wrong.method = PLD_METHOD_FRONT_TAIL) : void(wrong.tier = PLD_TIER_PUBLISHED);
    EXPECT_EQ(pld_create(&wrong, &pass), PLD_ERROR_UNSUPPORTED);
  }
  pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame good = host.frame();
  const GLuint small = makeTexture(GL_R8, 16, 15), depth = makeTexture(GL_DEPTH_COMPONENT32F, 16, 16);
  const auto refused = [&](auto change, pld_status expected) {
    pld_frame frame = good;
    change(frame);
    EXPECT_STREQ(pld_status_name(pld_begin(pass, PLD_STAGE_LAYERS, &frame)), pld_status_name(expected)) << pld_message(pass);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  };
  refused([](auto& f) { f.struct_size = offsetof(pld_frame, occlusion_texture); }, PLD_ERROR_TEXTURE);
  refused([](auto& f) { f.occlusion_texture = 4711; }, PLD_ERROR_TEXTURE);
  refused([&](auto& f) { f.occlusion_texture = small; }, PLD_ERROR_SIZE);
  refused([&](auto& f) { f.occlusion_texture = depth; }, PLD_ERROR_FORMAT);
  refused([](auto& f) { f.occlusion = static_cast<pld_occlusion>(2); }, PLD_ERROR_ARGUMENT);
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_RIMS, &good), PLD_ERROR_ORDER);
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &good), PLD_OK);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  const pld_target target = host.target();
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_ORDER);
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_RIMS, &good), PLD_OK);
  const GLuint gone = good.occlusion_texture;
  glDeleteTextures(1, &gone);
  EXPECT_EQ(pld_end(pass), PLD_ERROR_TEXTURE);
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);  // with rims as bright as they were
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
