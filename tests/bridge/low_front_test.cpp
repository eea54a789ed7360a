// Layers of low resolution under front+tail: laid over the nearest layer where they stand before it, else among the
// others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "composite/fold.h"
#include "composite/low_resolution.h"
#include "tests/bridge/host.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr shading::WeightSettings kWeight{shading::PLD_WEIGHT_EQ5, 0.1f, 100.0f, 3.0f, 1.0f};

FragmentLists listsOf(const Window& window, Random& random, bool coloured, std::uint32_t most,
                      const Image<float>& opaqueZ) {
  FragmentLists lists;
  lists.window = window;
  lists.solid = Image<glm::vec4>(window.width(), window.height(), glm::vec4(0, 0, 0, INFINITY));
  lists.offsets.push_back(0);
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x) {
      for (std::uint32_t i = random.below(most); i > 0; --i) {
        Fragment one{};
        one.coverage = .1f + .8f * random.uniformf();
        const float grey = .9f * random.uniformf();
        one.transmission =
            coloured ? glm::vec3(.9f * random.uniformf(), .9f * random.uniformf(), grey) : glm::vec3(grey);
        one.radiance = one.coverage * glm::vec3(random.uniformf(), 2 * random.uniformf(), .1f);
        one.z = 1.5f + 3.0f * random.uniformf();
        if (one.z <= opaqueZ.at(x, y)) lists.fragments.push_back(one);
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

// Of every pixel the nearest fragment, and the lists without it.
std::vector<Fragment> takeFronts(FragmentLists& lists) {
  std::vector<Fragment> fronts, rest;
  std::vector<std::uint64_t> offsets{0};
  for (std::size_t pixel = 0; pixel + 1 < lists.offsets.size(); ++pixel) {
    const auto first = lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[pixel]),
               end = lists.fragments.begin() + static_cast<std::ptrdiff_t>(lists.offsets[pixel + 1]);
    const auto nearest = std::min_element(first, end, [](const Fragment& a, const Fragment& b) { return a.z < b.z; });
    fronts.push_back(nearest == end ? Fragment{} : *nearest);
    for (auto one = first; one != end; ++one)
      if (one != nearest) rest.push_back(*one);
    offsets.push_back(rest.size());
  }
  lists.fragments = rest;
  lists.offsets.assign(offsets.begin(), offsets.end());
  return fronts;
}

TEST(BridgeLow, FrontAndTailLaysWhatIsBeforeOverTheNearest) {
  GlContext context;
  for (const bool coloured : {true, false})
    for (const int factor : {2, 4}) {
      Random random(9);
      GBuffer gbuffer;
      gbuffer.display = gbuffer.data = {0, 0, kWidth, kHeight};
      gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
      gbuffer.viewZ = Image<float>(kWidth, kHeight);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          gbuffer.beauty.at(x, y) = glm::vec4(random.uniformf(), random.uniformf(), (x / 9 + y / 7) % 2, 1.0f);
          gbuffer.viewZ.at(x, y) = x % 23 < 3 ? 3.0f : y > 30 ? 6.0f : INFINITY;
        }
      const FragmentLists full = listsOf(gbuffer.data, random, coloured, 4, gbuffer.viewZ);
      const LowView view = lowViewOf(gbuffer, full.solid, Camera{}, factor);
      const FragmentLists smoke = listsOf(view.gbuffer.data, random, coloured, 3, view.gbuffer.viewZ);
      // The rooms' upsampled layer alone, and the three ways to combine it.
      OitPlanes alone = emptyPlanes(gbuffer.display, gbuffer.data);
      alone.info.weight = kWeight;
      addLowResolution(folded(smoke), view, {.5, .5}, alone);
      FragmentLists others = full;
      const std::vector<Fragment> fronts = takeFronts(others);
      const OitPlanes tail = folded(others);
      OitPlanes both = tail;
      addLowResolution(folded(smoke), view, {.5, .5}, both);

      Host host(kWidth, kHeight);
      host.upload(gbuffer);
      pld_create_info info = host.info();
      info.method = PLD_METHOD_FRONT_TAIL;
      info.features = PLD_FEATURE_LOW_RESOLUTION;
      if (coloured) info.features |= PLD_FEATURE_COLOURED;
      pld_pass* pass = host.create(info);
      ASSERT_NE(pass, nullptr);
      pld_frame frame = host.frame();
      frame.low_factor = factor;
      for (int turn = 0; turn < 2; ++turn) {  // nothing of the last frame is left
        replay(pass, full, frame, {PLD_STAGE_FRONT, PLD_STAGE_LAYERS});
        replay(pass, smoke, frame, {PLD_STAGE_LOW});
      }
      const std::vector<float> found = host.finish(pass);

      double worst = 0;
      std::size_t before = 0, behind = 0, unknown = 0;
      for (std::size_t i = 0; i < fronts.size(); ++i) {
        const auto x = static_cast<int>(i) % kWidth, y = static_cast<int>(i) / kWidth;
        const shading::OitSums low = shading::unpackSums(alone.at(x, y));
        const bool shows = low.count > 0.0f, hasFront = fronts[i].coverage > 0.0f;
        const auto errorIf = [&](bool over) {
          shading::Resolved resolved = shading::resolveSums(shading::unpackSums((over ? tail : both).at(x, y)), false);
          if (hasFront) {
            const glm::vec3 passed = shading::passedBy(fronts[i].coverage, fronts[i].transmission);
            resolved.transparent = fronts[i].radiance + passed * resolved.transparent;
            resolved.transmission *= passed;
          }
          if (over) {
            // One layer: its light is what its sums add, or average.
            glm::vec3 light = low.light;
            for (int c = 0; c < 3; ++c)
              if (low.denominator[c] > 0.0f) light[c] += low.numerator[c] / low.denominator[c] * low.opacity[c];
            const glm::vec3 passed = shading::transmittanceOf(low.depth);
            resolved.transparent = light + passed * resolved.transparent;
            resolved.transmission *= passed;
          }
          const glm::vec3 expected = resolved.transparent + resolved.transmission * glm::vec3(gbuffer.beauty.at(x, y));
          double off = 0;
          for (int c = 0; c < 3; ++c)
            off = std::max(off, std::abs(static_cast<double>(expected[c]) -
                                         static_cast<double>(found[4 * i + static_cast<std::size_t>(c)])));
          return off;
        };
        if (!shows) {
          worst = std::max(worst, errorIf(false));
          continue;
        }
        // The upsampled layer's own depth, which one that hides less than a thousandth does not leave in its sums.
        const float hidden = shading::meanOf(low.opacity), z = low.opacityZ / std::max(hidden, 1e-30f),
                    frontZ = hasFront ? fronts[i].z : INFINITY;
        if (!(hidden > 0.0f) || std::abs(z - frontZ) < 1e-5f * z) {
          ++unknown;
          worst = std::max(worst, std::min(errorIf(true), errorIf(false)));
          continue;
        }
        ++(z < frontZ ? before : behind);
        worst = std::max(worst, errorIf(z < frontZ));
      }
      std::printf(
          "low resolution at 1/%d under front+tail, %s: smoke before the nearest layer in %zu pixels, behind it in "
          "%zu, not known in %zu: off by at "
          "most %.2g\n",
          factor, coloured ? "coloured" : "grey", before, behind, unknown, worst);
      EXPECT_LT(unknown, (before + behind) / 20);
      EXPECT_GT(before, 300u);
      EXPECT_GT(behind, 300u);
      EXPECT_LT(worst, 2e-6);  // the rooms' layer comes back from its sums by two divisions
    }
}

}  // namespace
}  // namespace pellucid::test
