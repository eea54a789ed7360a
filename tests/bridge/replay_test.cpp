// The bridge against the offline program, on the same fragments in the same order: seam, planes and resolve.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "composite/fold.h"
#include "composite/fold_published.h"
#include "composite/methods/method.h"
#include "composite/resolve.h"
#include "gbuffer/published.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 120, kHeight = 90;
constexpr shading::WeightSettings kWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

struct Wanted {
  bool coloured = true, light = true, refracts = false, diffuses = false, disperses = false, solids = false;
};

struct Shot {
  GBuffer gbuffer;
  FragmentLists lists;

  explicit Shot(const Wanted& wanted) {
    Random random(7);
    gbuffer.display = gbuffer.data = lists.window = {0, 0, kWidth, kHeight};
    gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
    gbuffer.viewZ = Image<float>(kWidth, kHeight);
    lists.solid = Image<glm::vec4>(kWidth, kHeight, glm::vec4(0, 0, 0, INFINITY));
    lists.offsets.push_back(0);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        gbuffer.beauty.at(x, y) =
            glm::vec4(random.uniformf(), 3 * random.uniformf(), (x / 9 + y / 7) % 2, random.below(3) ? 1.0f : 0.5f);
        gbuffer.viewZ.at(x, y) = (x / 20) % 3 ? 20.0f : (y / 16) % 2 ? 12.0f : INFINITY;
        const std::uint32_t layers = random.below(4) ? random.below(9) : 0;
        for (std::uint32_t i = 0; i < layers; ++i) add(random, wanted);
        if (wanted.solids && random.below(3) == 0) {
          Fragment solid{};
          solid.radiance = glm::vec3(random.uniformf(), 1.0f, 0.25f);
          solid.coverage = 1.0f;
          solid.z = 2.0f + 4.0f * random.uniformf();
          lists.fragments.push_back(solid);
          if (!lists.dispersion.empty() || wanted.disperses) lists.dispersion.emplace_back(0.0f);
          lists.solid.at(x, y) = glm::vec4(solid.radiance, solid.z);
        }
        lists.offsets.push_back(lists.fragments.size());
      }
  }

 private:
  void add(Random& random, const Wanted& wanted) {
    Fragment fragment{};
    fragment.coverage = wanted.light && random.below(6) == 0 ? 0.0f : 0.9f * random.uniformf() + 0.05f;
    const float grey = random.uniformf();
    // Within a thousandth of 1 it adds light.
    const float most = wanted.light ? 1.0f : 0.998f;
    fragment.transmission =
        most * (wanted.coloured
                    ? glm::vec3(random.uniformf(), random.below(3) || !wanted.light ? random.uniformf() : 1.0f, grey)
                    : glm::vec3(0.9f * grey));
    fragment.radiance = glm::vec3(random.uniformf(), 50 * random.uniformf(), 0.01f);
    fragment.z = 1.0f + 8.0f * random.uniformf();
    glm::vec4 dispersion(0.0f);
    if (wanted.refracts && random.below(2)) {
      fragment.offset = glm::vec2(40 * random.uniformf() - 20, 30 * random.uniformf() - 15);
      if (random.below(2)) dispersion = glm::vec4(-1, 0.5f, 2 * random.uniformf(), -0.25f);
    }
    if (wanted.diffuses && random.below(3) == 0) fragment.variance = 60.0f * random.uniformf();
    fragment.identity = static_cast<std::uint32_t>(lists.fragments.size());
    lists.fragments.push_back(fragment);
    if (wanted.disperses) lists.dispersion.push_back(dispersion);
  }
};

uint32_t featuresOf(const Wanted& wanted) {
  uint32_t features = 0;
  const auto add = [&](bool has, pld_feature feature) { features |= has ? static_cast<uint32_t>(feature) : 0u; };
  add(wanted.coloured, PLD_FEATURE_COLOURED);
  add(wanted.light, PLD_FEATURE_LIGHT);
  add(wanted.refracts, PLD_FEATURE_REFRACTION);
  add(wanted.diffuses, PLD_FEATURE_DIFFUSION);
  add(wanted.disperses, PLD_FEATURE_DISPERSION);
  add(wanted.solids, PLD_FEATURE_SOLIDS);
  return features;
}

Image<glm::vec4> offline(const Shot& shot) {
  OitPlanes planes = emptyPlanes(shot.gbuffer.display, shot.gbuffer.data);
  planes.info.weight = kWeight;
  foldFragments(shot.lists, kWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
  return compose(resolveOver(planes, {}, {}, shot.gbuffer), shot.gbuffer).rgba;
}

std::vector<float> bridged(const Shot& shot, const Wanted& wanted, pld_tier tier, pld_method method) {
  Host host(kWidth, kHeight);
  host.upload(shot.gbuffer);
  pld_create_info info = host.info();
  info.features = featuresOf(wanted);
  info.tier = tier;
  info.method = method;
  info.fragments_per_pixel = 10.0f;
  info.storage_binding = 7;
  pld_pass* pass = host.create(info);
  if (!pass) return {};
  std::vector<pld_stage> stages;
  if (wanted.solids) stages.push_back(PLD_STAGE_SOLIDS);
  if (method == PLD_METHOD_FRONT_TAIL && tier != PLD_TIER_EXACT) stages.push_back(PLD_STAGE_FRONT);
  stages.push_back(PLD_STAGE_LAYERS);
  replay(pass, shot.lists, host.frame(), stages);
  return host.finish(pass);
}

struct Difference {
  std::size_t words = 0;
  double largest = 0;
};
Difference compare(const Image<glm::vec4>& expected, const std::vector<float>& found) {
  Difference difference;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float a = expected[i / 4][static_cast<int>(i % 4)], b = found[i];
    if (std::memcmp(&a, &b, sizeof(a)) != 0) ++difference.words;
    difference.largest =
        std::max(difference.largest, std::abs(double(a) - double(b)) / std::max(1.0, std::abs(double(a))));
  }
  return difference;
}

void expectSameBits(const char* what, const Wanted& wanted) {
  GlContext context;
  const Shot shot(wanted);
  const Image<glm::vec4> expected = offline(shot);
  const std::vector<float> found = bridged(shot, wanted, PLD_TIER_FLOAT, PLD_METHOD_PHENOMENOLOGICAL);
  ASSERT_EQ(found.size(), expected.size() * 4);
  const Difference difference = compare(expected, found);
  std::printf("bridge against composite, replayed fragments, %s: %zu of %zu words differ, by %.2g\n", what,
              difference.words, found.size(), difference.largest);
  EXPECT_EQ(difference.words, 0u) << what;
  const Difference untouched = compare(shot.gbuffer.beauty, found);
  EXPECT_GT(untouched.words, found.size() / 3);
}

TEST(BridgeReplay, GreyLayersGiveTheOfflineBits) {
  expectSameBits("grey", {.coloured = false, .light = false});
}
TEST(BridgeReplay, ColouredLayersGiveTheOfflineBits) {
  expectSameBits("coloured", {.light = false});
}
TEST(BridgeReplay, ColouredLayersAndLightGiveTheOfflineBits) {
  expectSameBits("coloured, light", {});
}
TEST(BridgeReplay, SolidsGiveTheOfflineBits) {
  expectSameBits("solids", {.solids = true});
}
TEST(BridgeReplay, RefractionGivesTheOfflineBits) {
  expectSameBits("refraction", {.refracts = true});
}
TEST(BridgeReplay, DiffusionGivesTheOfflineBits) {
  expectSameBits("diffusion", {.diffuses = true});
}
TEST(BridgeReplay, ScatteringWithoutLightGivesTheOfflineBits) {
  expectSameBits("refraction, diffusion", {.light = false, .refracts = true, .diffuses = true});
  expectSameBits("refraction, dispersion, diffusion, solids, no light",
                 {.light = false, .refracts = true, .diffuses = true, .disperses = true, .solids = true});
  expectSameBits("grey, refraction, diffusion",
                 {.coloured = false, .light = false, .refracts = true, .diffuses = true});
  expectSameBits("grey, refraction", {.coloured = false, .light = false, .refracts = true});
}

// Which had no say: the plane came with refraction.
TEST(BridgeReplay, HostsBeforeVersionFourKeepTheLightOfWhatScatters) {
  GlContext context;
  const Wanted wanted{.refracts = true, .diffuses = true};
  const Shot shot(wanted);
  Host host(kWidth, kHeight);
  host.upload(shot.gbuffer);
  pld_create_info info = host.info();
  info.features = featuresOf(wanted) & ~static_cast<uint32_t>(PLD_FEATURE_LIGHT);
  info.version = PLD_VERSION_MAJOR << 20 | 3 << 10;
  pld_pass* pass = host.create(info);
  ASSERT_NE(pass, nullptr);
  replay(pass, shot.lists, host.frame(), {PLD_STAGE_LAYERS});
  EXPECT_EQ(compare(offline(shot), host.finish(pass)).words, 0u);
}

TEST(BridgeReplay, AllPhenomenaGiveTheOfflineBits) {
  expectSameBits("refraction, dispersion, diffusion, solids",
                 {.refracts = true, .diffuses = true, .disperses = true, .solids = true});
}
TEST(BridgeReplay, GreyScatteringGivesTheOfflineBits) {
  expectSameBits("grey, light, refraction, diffusion", {.coloured = false, .refracts = true, .diffuses = true});
  expectSameBits("grey, refraction", {.coloured = false, .light = false, .refracts = true});
}

// The nearest layer that diffuses takes no plane that it does not need, and the others' depths are kept for low
// resolution alone.
TEST(BridgeReplay, PlanesHoldNothingThatIsNotRead) {
  GlContext context;
  Host host(8, 8);
  constexpr uint32_t both = PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  const struct {
    pld_tier tier;
    uint32_t features;
    uint64_t planes, bits;
  } cases[] = {{PLD_TIER_FLOAT, both | PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, 6, 768},
               {PLD_TIER_FLOAT, both | PLD_FEATURE_LIGHT, 5, 576},
               {PLD_TIER_FLOAT, PLD_FEATURE_REFRACTION | PLD_FEATURE_LIGHT, 5, 576},
               {PLD_TIER_HALF, both | PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, 6, 384},
               {PLD_TIER_HALF, both | PLD_FEATURE_LIGHT, 5, 288},
               {PLD_TIER_HALF, PLD_FEATURE_REFRACTION | PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT, 6, 384},
               {PLD_TIER_FLOAT, both | PLD_FEATURE_COLOURED, 4, 512},
               {PLD_TIER_FLOAT, both, 3, 384},
               {PLD_TIER_HALF, both | PLD_FEATURE_COLOURED, 4, 256}};
  for (const auto& one : cases) {
    pld_create_info info = host.info();
    info.tier = one.tier;
    info.features = one.features;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    uint64_t planes = 0, bits = 0;
    EXPECT_EQ(pld_query(pass, PLD_VALUE_PLANES, &planes), PLD_OK);
    EXPECT_EQ(pld_query(pass, PLD_VALUE_BITS_PER_PIXEL, &bits), PLD_OK);
    EXPECT_EQ(planes, one.planes);
    EXPECT_EQ(bits, one.bits);
    pld_destroy(&pass);
  }
}

// The driver blends 8 and 16 bit targets in its own arithmetic, so it is its planes that go through the offline
// decoder.
OitPlanes decoded(pld_pass* pass, const Shot& shot, bool scatters) {
  OitPlanes planes = emptyPublishedPlanes(shot.gbuffer.display, shot.gbuffer.data);
  planes.info.weight = kWeight;
  planes.solid = shot.lists.solid;
  if (scatters) addScatterPlanes(planes);
  uint64_t names[3] = {};
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(pld_query(pass, static_cast<pld_value>(PLD_VALUE_FIRST_PLANE + i), &names[i]), PLD_OK);
  constexpr std::size_t pixels = static_cast<std::size_t>(kWidth) * kHeight;
  std::vector<float> radiance(pixels * 4);
  std::vector<std::uint8_t> beta(pixels * 4);
  std::vector<std::int8_t> delta(pixels * 2);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  const auto bytes = [](const auto& texels) { return static_cast<GLsizei>(texels.size() * sizeof(texels[0])); };
  glGetTextureImage(static_cast<GLuint>(names[0]), 0, GL_RGBA, GL_FLOAT, bytes(radiance), radiance.data());
  glGetTextureImage(static_cast<GLuint>(names[1]), 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes(beta), beta.data());
  if (scatters) glGetTextureImage(static_cast<GLuint>(names[2]), 0, GL_RG, GL_BYTE, bytes(delta), delta.data());
  PublishedClamps clamps;
  for (std::size_t i = 0; i < pixels; ++i) {
    PublishedPixel pixel;
    for (std::size_t c = 0; c < 4; ++c) pixel.radiance[static_cast<int>(c)] = radiance[4 * i + c];
    for (std::size_t c = 0; c < 4; ++c) pixel.beta[c] = beta[4 * i + c];
    for (std::size_t c = 0; c < 2; ++c) pixel.delta[c] = delta[2 * i + c];
    storePublished(pixel, planes, static_cast<int>(i) % kWidth, static_cast<int>(i) / kWidth, clamps);
  }
  return planes;
}

TEST(BridgeReplay, PublishedTierResolvesItsPlanesToTheOfflineBits) {
  GlContext context;
  for (const bool scatters : {false, true}) {
    const Wanted wanted{.light = false, .refracts = scatters, .diffuses = scatters};
    const Shot shot(wanted);
    Host host(kWidth, kHeight);
    host.upload(shot.gbuffer);
    pld_create_info info = host.info();
    info.features = featuresOf(wanted);
    info.tier = PLD_TIER_PUBLISHED;
    pld_pass* pass = host.create(info);
    ASSERT_NE(pass, nullptr);
    replay(pass, shot.lists, host.frame(), {PLD_STAGE_LAYERS});
    const pld_target target = host.target();
    ASSERT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    const OitPlanes planes = decoded(pass, shot, scatters);
    const Difference difference =
        compare(compose(resolveOver(planes, {}, {}, shot.gbuffer), shot.gbuffer).rgba, host.picture());
    std::printf("published%s: resolve of its own planes against the offline one: %zu words differ, by %.2g\n",
                scatters ? ", scattering" : "", difference.words, difference.largest);
    EXPECT_EQ(difference.words, 0u);
    // The planes: a step a layer, eight layers.
    OitPlanes folded = emptyPublishedPlanes(shot.gbuffer.display, shot.gbuffer.data);
    PublishedClamps clamps;
    foldPublished(shot.lists, kWeight, folded, clamps);
    double worst = 0;
    for (std::size_t i = 0; i < planes.depth.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst,
                         std::abs(static_cast<double>(planes.depth[i][c]) - static_cast<double>(folded.depth[i][c])));
    std::printf("published: beta is %.1f steps from the offline fold's at most\n", worst * 255);
    EXPECT_LE(worst, 8.01 / 255);
    EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  }
}

// Eight additions in two sums, 2^-10 of each where the driver cuts instead of rounding.
TEST(BridgeReplay, HalfTierIsNear) {
  GlContext context;
  const Wanted wanted;
  const Shot shot(wanted);
  const Difference difference = compare(offline(shot), bridged(shot, wanted, PLD_TIER_HALF, PLD_METHOD_WEIGHTED));
  std::printf("half tier: differs by %.2g relative at most\n", difference.largest);
  EXPECT_LT(difference.largest, 16 * std::ldexp(1.0, -10));
  EXPECT_GT(difference.words, 0u);
}

// On average: eight roundings of 2^-11. At the edges of what is seen through, an offset of halves may show the other
// side.
TEST(BridgeReplay, HalfTierThatScattersIsNearOnAverage) {
  GlContext context;
  for (const bool coloured : {true, false})
    for (const bool light : {true, false}) {
      const Wanted wanted{.coloured = coloured, .light = light, .refracts = true, .diffuses = true};
      const Shot shot(wanted);
      const Image<glm::vec4> expected = offline(shot);
      const std::vector<float> found = bridged(shot, wanted, PLD_TIER_HALF, PLD_METHOD_PHENOMENOLOGICAL);
      ASSERT_EQ(found.size(), expected.size() * 4);
      double sum = 0;
      for (std::size_t i = 0; i < found.size(); ++i)
        sum += std::abs(double(expected[i / 4][static_cast<int>(i % 4)]) - double(found[i])) /
               std::max(1.0, std::abs(double(found[i])));
      const double mean = sum / static_cast<double>(found.size());
      std::printf("half tier, %s%s, refraction, diffusion: mean relative difference %.2g\n",
                  coloured ? "coloured" : "grey", light ? ", light" : "", mean);
      EXPECT_LT(mean, 8 * std::ldexp(1.0, -11));
    }
}

TEST(BridgeReplay, FrontAndTailIsTheMethod) {
  GlContext context;
  for (const bool coloured : {true, false}) {
    const Wanted wanted{.coloured = coloured, .light = coloured};
    const Shot shot(wanted);
    Veil veil(kWidth, kHeight);
    MethodChoice choice;
    choice.weight = kWeight;
    compositeBy(*chooseMethod("front+tail"), choice, shot.lists, shot.gbuffer.data, veil);
    const Image<glm::vec4> expected = compose(veil, shot.gbuffer).rgba;
    for (const pld_tier tier : {PLD_TIER_FLOAT, PLD_TIER_EXACT}) {
      const std::vector<float> found = bridged(shot, wanted, tier, PLD_METHOD_FRONT_TAIL);
      ASSERT_EQ(found.size(), expected.size() * 4);
      const Difference difference = compare(expected, found);
      std::printf("front+tail, %s, %s: against the method in double by %.2g at most\n", coloured ? "coloured" : "grey",
                  tier == PLD_TIER_EXACT ? "exact" : "float", difference.largest);
      // Float sums of nine layers and a float quotient; of the exact tier the quotient alone.
      EXPECT_LT(difference.largest, tier == PLD_TIER_EXACT ? 1e-6 : 2e-5);
    }
  }
}

}  // namespace
}  // namespace pellucid::test
