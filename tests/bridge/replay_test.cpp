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
#include "tests/bridge/replayed_shot.h"

namespace pellucid::test {
namespace {

Image<glm::vec4> offline(const Shot& shot) {
  OitPlanes planes = emptyPlanes(shot.gbuffer.display, shot.gbuffer.data);
  planes.info.weight = kShotWeight;
  foldFragments(shot.lists, kShotWeight, shading::PLD_NORMALISE_SPECTRAL, planes);
  return compose(resolveOver(planes, {}, {}, shot.gbuffer), shot.gbuffer).rgba;
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
  Host host(kShotWidth, kShotHeight);
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
  planes.info.weight = kShotWeight;
  planes.solid = shot.lists.solid;
  if (scatters) addScatterPlanes(planes);
  uint64_t names[3] = {};
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(pld_query(pass, static_cast<pld_value>(PLD_VALUE_FIRST_PLANE + i), &names[i]), PLD_OK);
  constexpr std::size_t pixels = static_cast<std::size_t>(kShotWidth) * kShotHeight;
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
    storePublished(pixel, planes, static_cast<int>(i) % kShotWidth, static_cast<int>(i) / kShotWidth, clamps);
  }
  return planes;
}

TEST(BridgeReplay, PublishedTierResolvesItsPlanesToTheOfflineBits) {
  GlContext context;
  for (const bool scatters : {false, true}) {
    const Wanted wanted{.light = false, .refracts = scatters, .diffuses = scatters};
    const Shot shot(wanted);
    Host host(kShotWidth, kShotHeight);
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
    foldPublished(shot.lists, kShotWeight, folded, clamps);
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
    Veil veil(kShotWidth, kShotHeight);
    MethodChoice choice;
    choice.weight = kShotWeight;
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
