// Rims of leaves through the C library against the rooms: the light from around apart, darkened by the opaque pixels
// beside.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>

#include "composite/fold.h"
#include "composite/fold_published.h"
#include "composite/methods/method.h"
#include "composite/occlusion.h"
#include "composite/resolve.h"
#include "composite/rims.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 90, kHeight = 70, kLayers = 5;
constexpr shading::WeightSettings kWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

// Leaves before a wall and before each other: five fragments in a pixel, most of them rims.
struct Leaves {
  GBuffer gbuffer;
  FragmentLists lists;
  OccluderPlanes occluders;
  RimPlanes rims{kWidth, kHeight};
  std::vector<glm::vec4> aroundOf, gradientOf;                         // of each of the lists' fragments
  Image<glm::vec4> look[kLayers], around[kLayers], gradient[kLayers];  // radiance, coverage; around, z; gradient

  explicit Leaves(bool solids) {
    Random random(11);
    gbuffer.display = gbuffer.data = lists.window = occluders.data = {0, 0, kWidth, kHeight};
    gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
    gbuffer.viewZ = occluders.viewZ = occluders.occlusion = Image<float>(kWidth, kHeight);
    lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, INFINITY));
    for (int i = 0; i < kLayers; ++i)
      look[i] = around[i] = gradient[i] = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0.0f));
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
          const glm::vec2 slope =
              random.below(5) == 0 ? glm::vec2(0) : glm::vec2(random.uniformf() - .5f, random.uniformf() - .5f);
          look[i].at(x, y) = glm::vec4(one.radiance, one.coverage);
          around[i].at(x, y) = glm::vec4(.75f * one.radiance, one.z);
          gradient[i].at(x, y) = glm::vec4(slope, 0, 0);
          glm::vec4& solid = lists.solid.at(x, y);
          if (one.coverage == 1.0f && one.z < solid.a && one.z <= gbuffer.viewZ.at(x, y))
            solid = glm::vec4(one.radiance, one.z);
          seen.push_back(one);
        }
        occluders.viewZ.at(x, y) = std::min(gbuffer.viewZ.at(x, y), lists.solid.at(x, y).a);
        std::size_t next = 0;
        for (int i = 0; i < kLayers; ++i) {
          if (look[i].at(x, y).a == 0.0f) continue;
          const Fragment one = seen[next++];
          if (one.z > gbuffer.viewZ.at(x, y) || (one.coverage < 1.0f && one.z > lists.solid.at(x, y).a)) continue;
          lists.fragments.push_back(one);
          aroundOf.push_back(around[i].at(x, y));
          gradientOf.push_back(gradient[i].at(x, y));
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

  // The fragments as `composite` lists them: each rim darkened by its own neighbours.
  FragmentLists darkened(int form) const {
    FragmentLists dark = lists;
    for (std::size_t pixel = 0; pixel + 1 < lists.offsets.size(); ++pixel)
      for (std::size_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
        Fragment& one = dark.fragments[i];
        if (!shading::isRim(one.coverage)) continue;
        const shading::OcclusionSearch search = shading::occlusionSearch(glm::vec2(gradientOf[i]));
        const glm::ivec2 place(static_cast<int>(pixel) % kWidth, static_cast<int>(pixel) / kWidth);
        const float hidden =
            1.0f - shading::occlusionFrom(neighboursOcclusion(occluders, place, search, one.z, form), form);
        one.radiance -= hidden * glm::vec3(aroundOf[i]);
      }
    return dark;
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

struct How {
  uint32_t features;
  pld_occlusion form;
  int version = 450;
  pld_method method = PLD_METHOD_PHENOMENOLOGICAL;
  pld_tier tier = PLD_TIER_FLOAT;
};

//   sums  filled with the first plane of the layers, if it is asked for
std::vector<float> bridged(const Leaves& leaves, const How& how, std::vector<float>* sums = nullptr) {
  const uint32_t features = how.features;
  const int version = how.version;
  Host host(kWidth, kHeight);
  host.upload(leaves.gbuffer);
  const GLuint open = makeTexture(GL_R32F, kWidth, kHeight);
  fillTexture(open, kWidth, kHeight, GL_RED, &leaves.occluders.occlusion.at(0, 0));
  pld_create_info info = host.info();
  info.features = features | PLD_FEATURE_RIMS;
  info.method = how.method;
  info.tier = how.tier;
  pld_pass* pass = host.create(info);
  if (!pass) return {};
  const bool fronts = how.method == PLD_METHOD_FRONT_TAIL, apart = !fronts && how.tier != PLD_TIER_PUBLISHED;
  pld_frame frame = host.frame();
  frame.occlusion_texture = open;
  frame.occlusion = how.form;
  GLuint array = 0, textures[3];
  glCreateVertexArrays(1, &array);
  for (GLuint& one : textures) one = makeTexture(GL_RGBA32F, kWidth, kHeight);
  std::vector<pld_stage> stages{PLD_STAGE_LAYERS};
  if (apart) stages.push_back(PLD_STAGE_RIMS);
  if (fronts) stages.insert(stages.begin(), PLD_STAGE_FRONT);
  if (features & PLD_FEATURE_SOLIDS) stages.insert(stages.begin(), PLD_STAGE_SOLIDS);
  for (const pld_stage stage : stages) {
    const char* seam = nullptr;
    EXPECT_EQ(pld_glsl(pass, stage, version, &seam), PLD_OK) << pld_message(pass);
    const GLuint program =
        makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + seam + kMain);
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
  uint64_t plane = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_FIRST_PLANE, &plane), PLD_OK);
  if (sums) *sums = readTexture(static_cast<GLuint>(plane), kWidth, kHeight, GL_RGBA);
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
  for (const Case& one :
       {Case{"coloured, light", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_RELATIVE, 450},
        Case{"coloured, light, published form", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_PUBLISHED, 450},
        Case{"GLSL 3.30", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_RELATIVE, 330},
        Case{"coloured, light, solids", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_SOLIDS,
             PLD_OCCLUSION_RELATIVE, 450},
        Case{"grey, without light", 0, PLD_OCCLUSION_RELATIVE, 450},
        Case{"grey, light, diffusion", PLD_FEATURE_LIGHT | PLD_FEATURE_DIFFUSION, PLD_OCCLUSION_RELATIVE, 450}}) {
    const Leaves leaves((one.features & PLD_FEATURE_SOLIDS) != 0);
    OitPlanes planes = emptyPlanes(leaves.gbuffer.display, leaves.gbuffer.data);
    planes.info.weight = kWeight;
    foldFragments(leaves.lists, kWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
    const Image<glm::vec4> open = compose(resolveOver(planes, {}, {}, leaves.gbuffer), leaves.gbuffer).rgba;
    const std::size_t rims = occludeRims(leaves.rims, leaves.occluders, static_cast<int>(one.form), planes);
    const Image<glm::vec4> expected = compose(resolveOver(planes, {}, {}, leaves.gbuffer), leaves.gbuffer).rgba;
    const std::vector<float> found = bridged(leaves, {one.features, one.form, one.version});
    ASSERT_EQ(found.size(), 4 * expected.size());
    std::size_t words = 0;
    double worst = 0, darkened = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const float value = expected[i / 4][static_cast<int>(i % 4)];
      words += std::memcmp(&value, &found[i], sizeof(value)) != 0;
      worst = std::max(worst, std::abs(static_cast<double>(value) - static_cast<double>(found[i])));
      darkened =
          std::max(darkened, static_cast<double>(open[i / 4][static_cast<int>(i % 4)]) - static_cast<double>(value));
    }
    std::printf(
        "rims, %s: %zu pixels with rims, darkened by up to %.2f; %zu of %zu words differ from the rooms', by at most "
        "%.2g\n",
        one.what, rims, darkened, words, found.size(), worst);
    EXPECT_GT(rims, 3000u);
    EXPECT_GT(darkened, .2);
    if (one.version >= 400)
      EXPECT_EQ(words, 0u);
    else
      EXPECT_LT(worst, 5e-7);  // GLSL 3.30 has no `precise`
  }
}

// Where the sums cannot give back what occlusion hides, layers take each rim dark, as the offline pass does.
TEST(BridgeRims, FrontAndTailTakesDarkRims) {
  GlContext context;
  struct Case {
    const char* what;
    uint32_t features;
    pld_occlusion form;
    int version;
  };
  for (const Case& one :
       {Case{"grey", 0, PLD_OCCLUSION_RELATIVE, 450},
        Case{"coloured, light, published form", PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, PLD_OCCLUSION_PUBLISHED, 450},
        Case{"solids", PLD_FEATURE_SOLIDS, PLD_OCCLUSION_RELATIVE, 450},
        Case{"GLSL 3.30", PLD_FEATURE_LIGHT, PLD_OCCLUSION_RELATIVE, 330}}) {
    const Leaves leaves((one.features & PLD_FEATURE_SOLIDS) != 0);
    MethodChoice choice;
    choice.weight = kWeight;
    const auto method = [&](const FragmentLists& lists) {
      Veil veil(kWidth, kHeight);
      compositeBy(*chooseMethod("front+tail"), choice, lists, leaves.gbuffer.data, veil);
      return compose(veil, leaves.gbuffer).rgba;
    };
    const Image<glm::vec4> expected = method(leaves.darkened(static_cast<int>(one.form))), open = method(leaves.lists);
    const std::vector<float> found = bridged(leaves, {one.features, one.form, one.version, PLD_METHOD_FRONT_TAIL});
    ASSERT_EQ(found.size(), 4 * expected.size());
    double worst = 0, darkened = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double value = static_cast<double>(expected[i / 4][static_cast<int>(i % 4)]);
      worst = std::max(worst, std::abs(value - static_cast<double>(found[i])));
      darkened = std::max(darkened, static_cast<double>(open[i / 4][static_cast<int>(i % 4)]) - value);
    }
    std::printf("rims under front+tail, %s: darkened by up to %.2f, off the method in double by %.2g\n", one.what,
                darkened, worst);
    EXPECT_GT(darkened, .2);
    EXPECT_LT(worst, 2e-5);  // as without rims: float sums and a float quotient
  }
}

TEST(BridgeRims, PublishedTargetsTakeDarkRims) {
  GlContext context;
  for (const bool solids : {false, true})
    for (const pld_occlusion form : {PLD_OCCLUSION_RELATIVE, PLD_OCCLUSION_PUBLISHED}) {
      const Leaves leaves(solids);
      const auto folded = [&](const FragmentLists& lists) {
        OitPlanes planes = emptyPublishedPlanes(leaves.gbuffer.display, leaves.gbuffer.data);
        PublishedClamps clamps;
        planes.info.weight = kWeight;
        foldPublished(lists, kWeight, planes, clamps);
        return planes;
      };
      const OitPlanes dark = folded(leaves.darkened(static_cast<int>(form))), open = folded(leaves.lists);
      const Image<glm::vec4> expected = compose(resolveOver(dark, {}, {}, leaves.gbuffer), leaves.gbuffer).rgba;
      std::vector<float> sums;
      const std::vector<float> found = bridged(
          leaves,
          {solids ? uint32_t{PLD_FEATURE_SOLIDS} : 0u, form, 450, PLD_METHOD_PHENOMENOLOGICAL, PLD_TIER_PUBLISHED},
          &sums);
      ASSERT_EQ(found.size(), 4 * expected.size());
      double off = 0, lost = 0, picture = 0;
      for (std::size_t i = 0; i < dark.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const double value = static_cast<double>(dark.radiance[i][c]),
                       brightest = std::max(static_cast<double>(open.radiance[i][c]), 1e-3);
          off = std::max(off,
                         std::abs(static_cast<double>(sums[4 * i + static_cast<std::size_t>(c)]) - value) / brightest);
          lost = std::max(lost, (brightest - value) / brightest);
          picture = std::max(picture, std::abs(static_cast<double>(found[4 * i + static_cast<std::size_t>(c)]) -
                                               static_cast<double>(expected[i][c])));
        }
      std::printf(
          "rims in the published tier%s, form %d: sums lose up to %.2f of themselves and are off the offline fold's by "
          "%.2g; picture %.2g\n",
          solids ? ", solids" : "", static_cast<int>(form), lost, off, picture);
      EXPECT_GT(lost, .4);
      EXPECT_LT(off, kLayers * std::ldexp(1.0, -10));  // halves, cut instead of rounded
      EXPECT_LT(picture, kLayers * 1.5 / 255);         // and a step of 8 bits for each layer
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
    // They have no stage of rims, nor a view of one, and their seam reads a unit more.
    wrong.texture_unit = 29;
    EXPECT_EQ(pld_create(&wrong, &pass), PLD_ERROR_ARGUMENT);
    wrong.texture_unit = 28;
    wrong.flags = PLD_FLAG_DEBUG_VIEWS;
    pass = host.create(wrong);
    ASSERT_NE(pass, nullptr);
    const char* text = nullptr;
    EXPECT_EQ(pld_glsl(pass, PLD_STAGE_RIMS, 330, &text), PLD_ERROR_ARGUMENT);
    pld_frame frame = host.frame();
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_RIMS, &frame), PLD_ERROR_ORDER);
    const pld_stage first = fronts ? PLD_STAGE_FRONT : PLD_STAGE_LAYERS;
    frame.occlusion_texture = 4711;
    EXPECT_EQ(pld_begin(pass, first, &frame), PLD_ERROR_TEXTURE);
    frame = host.frame();
    for (const pld_stage stage : {first, PLD_STAGE_LAYERS}) {
      ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
      ASSERT_EQ(pld_end(pass), PLD_OK);
    }
    pld_target target = host.target();
    target.view = PLD_VIEW_RIM_LOSS;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_UNSUPPORTED);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    pld_destroy(&pass);
  }
  pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  const pld_frame good = host.frame();
  const GLuint small = makeTexture(GL_R8, 16, 15), depth = makeTexture(GL_DEPTH_COMPONENT32F, 16, 16);
  const auto refused = [&](auto change, pld_status expected) {
    pld_frame frame = good;
    change(frame);
    EXPECT_STREQ(pld_status_name(pld_begin(pass, PLD_STAGE_LAYERS, &frame)), pld_status_name(expected))
        << pld_message(pass);
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
