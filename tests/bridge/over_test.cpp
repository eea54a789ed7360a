// PLD_METHOD_OVER against the offline truth, and what PLD_FEATURE_OUTPUTS tells of the layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "composite/over.h"
#include "composite/resolve.h"
#include "tests/bridge/replayed_shot.h"

namespace pellucid::test {
namespace {

Veil truthOf(const Shot& shot) {
  Veil veil(kShotWidth, kShotHeight);
  compositeSorted(shot.lists, shot.gbuffer.data, veil);
  return veil;
}

TEST(BridgeOver, IsTheOfflineTruthToTheBit) {
  GlContext context;
  for (const bool solids : {false, true})
    for (const bool light : {false, true}) {
      const Wanted wanted{.light = light, .solids = solids};
      const Shot shot(wanted);
      const Image<glm::vec4> expected = compose(truthOf(shot), shot.gbuffer).rgba;
      const std::vector<float> found = bridged(shot, wanted, PLD_TIER_EXACT, PLD_METHOD_OVER);
      ASSERT_EQ(found.size(), expected.size() * 4);
      const Difference difference = compare(expected, found);
      std::printf("over%s%s: %zu of %zu words differ from the offline truth, by %.2g\n", solids ? ", solids" : "",
                  light ? ", light" : "", difference.words, found.size(), difference.largest);
      EXPECT_EQ(difference.words, 0u);
      EXPECT_GT(compare(shot.gbuffer.beauty, found).words, found.size() / 3);
    }
}

// GLSL has no logarithm of doubles: layers in one plane merge by series, which end within a rounding of a float.
TEST(BridgeOver, LayersInOnePlaneMerge) {
  GlContext context;
  const Wanted wanted{.coincides = true};
  const Shot shot(wanted);
  const Difference difference =
      compare(compose(truthOf(shot), shot.gbuffer).rgba, bridged(shot, wanted, PLD_TIER_EXACT, PLD_METHOD_OVER));
  std::printf("over, layers in four planes: %zu words differ, by %.2g\n", difference.words, difference.largest);
  EXPECT_LE(difference.largest, 6e-8);
}

TEST(BridgeOver, NoOrderChangesABit) {
  GlContext context;
  for (const bool coincides : {false, true}) {
    const Wanted wanted{.solids = true, .coincides = coincides};
    Shot shot(wanted);
    const std::vector<float> forth = bridged(shot, wanted, PLD_TIER_EXACT, PLD_METHOD_OVER);
    for (std::size_t i = 0; i + 1 < shot.lists.offsets.size(); ++i)
      std::reverse(shot.lists.fragments.begin() + static_cast<std::ptrdiff_t>(shot.lists.offsets[i]),
                   shot.lists.fragments.begin() + static_cast<std::ptrdiff_t>(shot.lists.offsets[i + 1]));
    const std::vector<float> back = bridged(shot, wanted, PLD_TIER_EXACT, PLD_METHOD_OVER);
    ASSERT_EQ(forth.size(), back.size());
    EXPECT_EQ(std::memcmp(forth.data(), back.data(), forth.size() * sizeof(float)), 0) << coincides;
  }
}

// No feature is needed for what sums would have to be asked to keep.
TEST(BridgeOver, KeepsColourAndLightUnasked) {
  GlContext context;
  const Shot shot(Wanted{});
  const Wanted asked{.coloured = false, .light = false};
  EXPECT_EQ(
      compare(compose(truthOf(shot), shot.gbuffer).rgba, bridged(shot, asked, PLD_TIER_EXACT, PLD_METHOD_OVER)).words,
      0u);
}

TEST(BridgeOver, RefusesWhatItCannotSort) {
  GlContext context;
  Host host(16, 16);
  const auto refused = [&](auto change, const char* expected) {
    pld_create_info info = host.info();
    info.method = PLD_METHOD_OVER;
    info.tier = PLD_TIER_EXACT;
    info.fragments_per_pixel = 4.0f;
    change(info);
    pld_pass* pass = nullptr;
    EXPECT_EQ(pld_create(&info, &pass), PLD_ERROR_UNSUPPORTED);
    EXPECT_NE(host.log.last().find(expected), std::string::npos) << host.log.last();
    pld_destroy(&pass);
  };
  refused([](pld_create_info& info) { info.tier = PLD_TIER_FLOAT; }, "PLD_METHOD_OVER without PLD_TIER_EXACT");
  refused([](pld_create_info& info) { info.features = PLD_FEATURE_DIFFUSION; }, "PLD_METHOD_OVER with");
  refused([](pld_create_info& info) { info.features = PLD_FEATURE_LOW_RESOLUTION; }, "PLD_METHOD_OVER with");
  refused(
      [](pld_create_info& info) {
        info.method = PLD_METHOD_WEIGHTED;
        info.tier = PLD_TIER_PUBLISHED;
        info.features = PLD_FEATURE_OUTPUTS;
      },
      "PLD_FEATURE_OUTPUTS with PLD_TIER_PUBLISHED");
}

// Both outputs of a shot by one method and tier.
struct Outputs {
  std::vector<float> reactive, depth;
};
Outputs outputsOf(const Shot& shot, const Wanted& wanted, pld_tier tier, pld_method method) {
  Host host(kShotWidth, kShotHeight);
  pld_pass* pass = drawnBy(host, shot, wanted, tier, method, PLD_FEATURE_OUTPUTS);
  if (!pass) return {};
  Outputs outputs;
  for (const pld_view view : {PLD_VIEW_REACTIVE, PLD_VIEW_NEAREST_DEPTH}) {
    pld_target target = host.target();
    target.view = view;
    EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
    (view == PLD_VIEW_REACTIVE ? outputs.reactive : outputs.depth) = host.picture();
  }
  pld_destroy(&pass);
  return outputs;
}

TEST(BridgeOutputs, DepthIsTheNearestLayersAndTheMaskIsWhatLayersHide) {
  GlContext context;
  const struct {
    const char* what;
    pld_tier tier;
    pld_method method;
    double tolerance;  // of 1 - beta: the sums keep optical depth, in halves to eleven bits over nine layers
  } kinds[] = {{"over", PLD_TIER_EXACT, PLD_METHOD_OVER, 1e-7},
               {"exact sums", PLD_TIER_EXACT, PLD_METHOD_WEIGHTED, 1e-6},
               {"float sums", PLD_TIER_FLOAT, PLD_METHOD_WEIGHTED, 2e-6},
               {"half sums", PLD_TIER_HALF, PLD_METHOD_WEIGHTED, 9 * 0x1p-11},
               {"front+tail", PLD_TIER_FLOAT, PLD_METHOD_FRONT_TAIL, 2e-6}};
  for (const auto& kind : kinds)
    for (const bool solids : {false, true}) {
      const Wanted wanted{.solids = solids};
      const Shot shot(wanted);
      const Veil truth = truthOf(shot);
      const Outputs outputs = outputsOf(shot, wanted, kind.tier, kind.method);
      ASSERT_EQ(outputs.depth.size(), truth.touched.size() * 4);
      double worst = 0;
      std::size_t deep = 0;
      for (std::size_t i = 0; i < truth.touched.size(); ++i) {
        const bool touched = truth.touched[i] != 0;
        const float nearest = touched ? truth.frontZ[i] : INFINITY;
        if (outputs.depth[4 * i] != nearest) ++deep;
        const glm::dvec3 through(truth.transmission[i]);
        const double hidden = touched ? 1.0 - (through.r + through.g + through.b) / 3.0 : 0.0;
        worst = std::max(worst, std::abs(hidden - double(outputs.reactive[4 * i])));
      }
      std::printf("outputs, %s%s: %zu depths differ, mask by %.2g\n", kind.what, solids ? ", solids" : "", deep, worst);
      EXPECT_EQ(deep, 0u) << kind.what;
      EXPECT_LE(worst, kind.tolerance) << kind.what;
    }
}

TEST(BridgeOutputs, AreAskedForAtCreation) {
  GlContext context;
  Host host(16, 16);
  pld_pass* pass = host.create(host.info());
  ASSERT_NE(pass, nullptr);
  pld_frame frame = host.frame();
  ASSERT_EQ(pld_begin(pass, PLD_STAGE_LAYERS, &frame), PLD_OK);
  ASSERT_EQ(pld_end(pass), PLD_OK);
  pld_target target = host.target();
  target.view = PLD_VIEW_REACTIVE;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_ERROR_UNSUPPORTED);
  EXPECT_NE(std::string(pld_message(pass)).find("PLD_FEATURE_OUTPUTS"), std::string::npos);
  pld_destroy(&pass);
}

}  // namespace
}  // namespace pellucid::test
