// Layers at low resolution through the C library against the rooms: tested, resolved, upsampled and entered alike.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "composite/fold.h"
#include "composite/low_resolution.h"
#include "composite/methods/method.h"
#include "composite/resolve.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr shading::WeightSettings kWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

struct Wanted {
  const char* what;
  bool coloured, refracts, diffuses, solids;
  int factor;
  bool disperses = false;
};

FragmentLists listsOf(const Window& window, Random& random, const Wanted& wanted, bool low,
                      const Image<float>& opaqueZ) {
  FragmentLists lists;
  lists.window = window;
  lists.solid = Image<glm::vec4>(window.width(), window.height(), glm::vec4(0, 0, 0, INFINITY));
  lists.offsets.push_back(0);
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x) {
      // Smoke here, none there; glass in full resolution anywhere.
      const std::uint32_t layers = low ? ((x / 3 + y / 2) % 3 == 0 ? 0 : random.below(6)) : random.below(3);
      for (std::uint32_t i = 0; i < layers; ++i) {
        Fragment one{};
        one.coverage = random.below(8) == 0 ? 0.0f : .1f + .8f * random.uniformf();
        const float grey = random.uniformf();
        one.transmission =
            wanted.coloured ? glm::vec3(random.uniformf(), random.uniformf(), grey) : glm::vec3(.9f * grey);
        one.radiance = glm::vec3(random.uniformf(), 4 * random.uniformf(), .1f);
        one.z = 1.5f + 3.0f * random.uniformf();
        if (wanted.refracts && random.below(2))
          one.offset = glm::vec2(10 * random.uniformf() - 5, 8 * random.uniformf() - 4);
        if (wanted.diffuses && random.below(3) == 0)
          one.variance = 20.0f * random.uniformf() / static_cast<float>(low ? wanted.factor * wanted.factor : 1);
        if (random.below(16) == 0)
          one.transmission = glm::vec3(1), one.radiance = glm::vec3(0);  // bends and spreads unseen
        if (one.z > opaqueZ.at(x, y)) continue;
        lists.fragments.push_back(one);
        if (wanted.disperses) lists.dispersion.emplace_back(random.uniformf(), -.5f, .25f * random.uniformf(), .5f);
      }
      if (!low && wanted.solids && random.below(4) == 0) {
        Fragment solid{};
        solid.radiance = glm::vec3(random.uniformf(), 1.0f, 0.25f);
        solid.coverage = 1.0f;
        solid.z = 1.2f + .2f * random.uniformf();
        lists.fragments.push_back(solid);
        if (wanted.disperses) lists.dispersion.emplace_back(0.0f);
        lists.solid.at(x, y) = glm::vec4(solid.radiance, solid.z);
      }
      lists.offsets.push_back(lists.fragments.size());
    }
  return lists;
}

OitPlanes folded(const FragmentLists& lists) {
  OitPlanes planes = emptyPlanes(lists.window, lists.window);
  planes.info.weight = kWeight;
  foldFragments(lists, kWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
  return planes;
}

TEST(BridgeLow, UpsampledLayersAreThoseOfTheRooms) {
  GlContext context;
  for (const Wanted& wanted :
       {Wanted{"coloured, 1/2", true, false, false, false, 2},
        Wanted{"coloured, solids, 1/4", true, false, false, true, 4},
        Wanted{"coloured, 1/8", true, false, false, false, 8}, Wanted{"grey, 1/4", false, false, false, false, 4},
        Wanted{"grey, refraction, diffusion, solids, 1/2", false, true, true, true, 2},
        Wanted{"coloured, refraction, diffusion, 1/4", true, true, true, false, 4},
        Wanted{"grey, refraction, 1/8", false, true, false, false, 8},
        Wanted{"coloured, refraction, dispersion, diffusion, solids, 1/2", true, true, true, true, 2, true}}) {
    Random random(5);
    GBuffer gbuffer;
    gbuffer.display = gbuffer.data = {0, 0, kWidth, kHeight};
    gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
    gbuffer.viewZ = Image<float>(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        gbuffer.beauty.at(x, y) = glm::vec4(random.uniformf(), random.uniformf(), (x / 9 + y / 7) % 2, 1.0f);
        const bool post = x % 23 < 3 || (x > 50 && x < 66 && y > 20);
        gbuffer.viewZ.at(x, y) = post ? 2.5f : y > 40 ? 3.0f + .02f * static_cast<float>(y) : INFINITY;
      }
    // Glass stands before all that is opaque; the rooms fold every fragment that the lists hold.
    const FragmentLists full = listsOf(gbuffer.data, random, wanted, false, gbuffer.viewZ);
    OitPlanes planes = folded(full);
    const Image<glm::vec4> without = compose(resolveOver(planes, {}, {}, gbuffer), gbuffer).rgba;
    const LowView view = lowViewOf(gbuffer, full.solid, Camera{}, wanted.factor);
    const FragmentLists smoke = listsOf(view.gbuffer.data, random, wanted, true, view.gbuffer.viewZ);
    addLowResolution(folded(smoke), view, {.5, .5}, planes);
    const Image<glm::vec4> expected = compose(resolveOver(planes, {}, {}, gbuffer), gbuffer).rgba;

    Host host(kWidth, kHeight);
    host.upload(gbuffer);
    pld_create_info info = host.info();
    info.features = PLD_FEATURE_LOW_RESOLUTION | PLD_FEATURE_LIGHT;
    if (wanted.coloured) info.features |= PLD_FEATURE_COLOURED;
    if (wanted.refracts) info.features |= PLD_FEATURE_REFRACTION;
    if (wanted.diffuses) info.features |= PLD_FEATURE_DIFFUSION;
    if (wanted.solids) info.features |= PLD_FEATURE_SOLIDS;
    if (wanted.disperses) info.features |= PLD_FEATURE_DISPERSION;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    pld_frame frame = host.frame();
    frame.low_factor = wanted.factor;
    if (wanted.solids) replay(pass, full, frame, {PLD_STAGE_SOLIDS});
    replay(pass, full, frame, {PLD_STAGE_LAYERS});
    replay(pass, smoke, frame, {PLD_STAGE_LOW});
    const pld_target target = host.target();
    ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    const std::vector<float> found = host.picture();
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    std::size_t words = 0, changed = 0;
    double worst = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const float value = expected[i / 4][static_cast<int>(i % 4)];
      words += std::memcmp(&value, &found[i], sizeof(value)) != 0;
      worst = std::max(worst, std::abs(static_cast<double>(value) - static_cast<double>(found[i])));
      changed += value != without[i / 4][static_cast<int>(i % 4)];
    }
    std::printf("low resolution, %s: %zu of %zu words under smoke; %zu differ from the rooms', by at most %.2g\n",
                wanted.what, changed, found.size(), words, worst);
    EXPECT_GT(changed, found.size() / 3);
    EXPECT_EQ(words, 0u);
    pld_destroy(&pass);
  }
}

// A host's geometry under its own projection falls on the texels that the rooms' low view has: an even veil is the same
// veil at every factor.
TEST(BridgeLow, AnEvenVeilIsItselfAtEveryFactor) {
  GlContext context;
  std::vector<float> pictures[4];
  const int factors[] = {1, 2, 4, 8};
  for (int k = 0; k < 4; ++k) {
    Host host(kWidth, kHeight);
    pld_create_info info = host.info();
    info.features = PLD_FEATURE_LOW_RESOLUTION;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    GLuint array = 0;
    glCreateVertexArrays(1, &array);
    pld_frame frame = host.frame();
    frame.low_factor = factors[std::max(k, 1)];
    for (const pld_stage stage : {PLD_STAGE_LAYERS, PLD_STAGE_LOW}) {
      const char* seam = nullptr;
      ASSERT_EQ(pld_glsl(pass, stage, 330, &seam), PLD_OK) << pld_message(pass);
      const GLuint program =
          makeProgram(kFullscreenVertex, std::string("#version 330 core\n") + seam +
                                             "void main() { pldWriteFragment(pldSurface(vec3(0.2, 0.1, 0.4), 0.5, "
                                             "vec3(0.5), vec3(0.0, 0.0, -3.0))); }\n");
      ASSERT_EQ(pld_connect(pass, program), PLD_OK);
      ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
      glBindVertexArray(array);
      glUseProgram(program);
      if ((stage == PLD_STAGE_LAYERS) == (k == 0)) glDrawArrays(GL_TRIANGLES, 0, 3);
      ASSERT_EQ(pld_end(pass), PLD_OK);
      glDeleteProgram(program);
    }
    const pld_target target = host.target();
    ASSERT_EQ(pld_resolve(pass, &target), PLD_OK);
    pictures[k] = host.picture();
    pld_destroy(&pass);
  }
  for (int k = 1; k < 4; ++k) {
    double worst = 0;
    for (std::size_t i = 0; i < pictures[0].size(); ++i)
      worst = std::max(worst, std::abs(static_cast<double>(pictures[0][i]) - static_cast<double>(pictures[k][i])));
    std::printf("an even veil at 1/%d: off by at most %.2g\n", factors[k], worst);
    EXPECT_LT(worst, 1e-6);
  }
  EXPECT_NE(pictures[0][0], 0.5f);
}

// And so is an even pane that refracts and diffuses what stands behind it: its offset and spread are of pixels,
// whatever a texel is.
TEST(BridgeLow, AnEvenPaneScattersAlikeAtEveryFactor) {
  GlContext context;
  Host host(kWidth, kHeight);
  std::vector<float> wave;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const auto x = static_cast<float>(i % kWidth), y = static_cast<float>(i / kWidth);
    for (const float c :
         {.5f + .5f * std::sin(.4f * x), .5f + .5f * std::sin(.3f * y), .5f + .5f * std::sin(.2f * (x + y)), 1.0f})
      wave.push_back(c);
  }
  fillTexture(host.colour, kWidth, kHeight, GL_RGBA, wave.data());
  const char* const main = R"(
void main() {
  PldSurface pane = pldSurface(vec3(0.02), 0.75, vec3(0.9), vec3(0.25, 0.125, -3.0));
  pane.normal = normalize(vec3(0.2, 0.3, 1.0));
  pane.eta = 1.0 / 1.3;
  pane.etaRedBlue = vec2(1.0 / 1.28, 1.0 / 1.32);
  pane.collimation = 0.5;
  pldWriteFragment(pane);
}
)";
  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  for (const uint32_t features :
       {uint32_t{PLD_FEATURE_REFRACTION}, uint32_t{PLD_FEATURE_DIFFUSION},
        uint32_t{PLD_FEATURE_COLOURED | PLD_FEATURE_REFRACTION | PLD_FEATURE_DISPERSION | PLD_FEATURE_DIFFUSION}})
    // The last turn has the lens fixed, which is another one at low resolution.
    for (const int turn : {0, 1, 2}) {
      const bool half = turn == 1, fixes = turn == 2;
      pld_create_info info = host.info();
      info.features = features | PLD_FEATURE_LOW_RESOLUTION;
      info.tier = half ? PLD_TIER_HALF : PLD_TIER_FLOAT;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      const pld_stage stages[] = {PLD_STAGE_LAYERS, PLD_STAGE_LOW};
      const pld_frame perspective = host.frame();
      if (fixes) {
        ASSERT_EQ(pld_fix(pass, &perspective, PLD_FIXED_LENS), PLD_OK) << pld_message(pass);
      }
      GLuint programs[2] = {};
      for (int i = 0; i < 2; ++i) {
        const char* seam = nullptr;
        ASSERT_EQ(pld_glsl(pass, stages[i], 450, &seam), PLD_OK) << pld_message(pass);
        programs[i] = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + main);
        ASSERT_EQ(pld_connect(pass, programs[i]), PLD_OK);
      }
      for (const bool orthographic : {false, true}) {
        if (orthographic && fixes) continue;
        pld_frame frame = host.frame();
        frame.refract = PLD_REFRACT_AT_DISTANCE;
        frame.diffusion_k0 = .2f;
        if (orthographic) {
          const float flat[16] = {.25f * kHeight / kWidth, 0, 0, 0, 0, .25f, 0, 0, 0, 0, -.1f, 0, 0, 0, 0, 1};
          std::copy(flat, flat + 16, frame.projection);
        }
        std::vector<float> whole;
        for (const int factor : {1, 2, 4, 8}) {
          frame.low_factor = std::max(factor, 2);
          for (int i = 0; i < 2; ++i) {
            ASSERT_EQ(pld_begin(pass, stages[i], &frame), PLD_OK) << pld_message(pass);
            glBindVertexArray(array);
            glUseProgram(programs[i]);
            if ((i == 0) == (factor == 1)) glDrawArrays(GL_TRIANGLES, 0, 3);
            ASSERT_EQ(pld_end(pass), PLD_OK);
          }
          const pld_target target = host.target();
          ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
          const std::vector<float> picture = host.picture();
          if (factor == 1) {
            whole = picture;
            continue;
          }
          double worst = 0, moved = 0;  // beside the same pane without scattering
          for (std::size_t i = 0; i < picture.size(); ++i) {
            worst = std::max(worst, std::abs(static_cast<double>(picture[i]) - static_cast<double>(whole[i])));
            if (i % 4 != 3)
              moved = std::max(moved,
                               std::abs(static_cast<double>(whole[i]) - (.02 + .925 * static_cast<double>(wave[i]))));
          }
          std::printf(
              "an even pane at 1/%d, features %u%s%s: off by at most %.2g where it moves things by up to %.2g\n",
              factor, features, orthographic ? ", orthographic" : "", half ? ", half" : "", worst, moved);
          EXPECT_GT(moved, .02);
          // The upsampled offset, rounded, times the background's slope; halves round sums of 10 px and less by 2^-8.
          EXPECT_LT(worst, half ? .004 : 2e-5);
        }
      }
      for (const GLuint program : programs) glDeleteProgram(program);
      pld_destroy(&pass);
    }
  glDeleteVertexArrays(1, &array);
}

TEST(BridgeLow, WrongFactorsAreRefused) {
  GlContext context;
  Host host(18, 16);
  pld_create_info info = host.info();
  info.features = PLD_FEATURE_LOW_RESOLUTION;
  pld_pass* pass = nullptr;
  pld_create_info wrong = info;
  wrong.tier = PLD_TIER_PUBLISHED;
  EXPECT_EQ(pld_create(&wrong, &pass), PLD_ERROR_UNSUPPORTED);
  wrong = info;
  wrong.method = PLD_METHOD_FRONT_TAIL;
  wrong.tier = PLD_TIER_EXACT;
  wrong.fragments_per_pixel = 4.0f;
  EXPECT_EQ(pld_create(&wrong, &pass), PLD_ERROR_UNSUPPORTED);
  pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  for (const int factor : {-2, 0, 1, 3, 16}) {
    frame.low_factor = factor;
    EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_ARGUMENT) << factor;
  }
  frame.low_factor = 4;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_ERROR_SIZE);
  frame.low_factor = 2;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LOW, &frame), PLD_ERROR_ORDER);
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK) << pld_message(pass);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  frame.width = 16;
  EXPECT_EQ(pld_begin(pass, PLD_STAGE_LOW, &frame), PLD_ERROR_SIZE);
  const pld_target target = host.target();
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_ORDER);
  frame.width = 18;
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LOW, &frame), PLD_OK) << pld_message(pass);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(host.picture(), readTexture(host.colour, 18, 16, GL_RGBA));  // nothing was drawn
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
