// The stated error is never exceeded, and something is gained by stating it.
#include <gtest/gtest.h>

#include "composite/over.h"
#include "composite/tolerance.h"
#include "gbuffer/gbuffer.h"
#include "tests/support/layers.h"
#include "tests/truth/sets.h"

namespace pellucid {
namespace {

using namespace test;

GBuffer backgroundFor(const FragmentLists& lists, Random& random) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = lists.window;
  gbuffer.beauty = Image<glm::vec4>(lists.window.width(), 1, glm::vec4(1));
  for (int x = 0; x < lists.window.width(); ++x)
    for (int c = 0; c < 3; ++c) gbuffer.beauty.at(x, 0)[c] = random.uniformf() * 2;
  return gbuffer;
}

TEST(Tolerance, NeverViolatedOnSixtyThousandStacks) {
  for (const double tolerance : {.004, .05}) {
    double worst = 0;
    ToleranceCounts counts;
    for (std::uint64_t batch = 0; batch < 60; ++batch) {
      Random random(900 + batch);
      std::vector<std::vector<Fragment>> pixels(1000);
      for (auto& pixel : pixels) {
        // Thin, similar layers are what a certificate is for; the five sets are the hard cases.
        const std::uint32_t kind = random.below(8);
        if (kind < 5) {
          pixel = pixelOfSet("ABCDE"[kind], random, random.below(2) == 0);
        } else {
          const std::uint32_t count = 1 + random.below(20);
          const glm::vec3 hue(random.uniformf(), random.uniformf(), random.uniformf());
          for (std::uint32_t i = 0; i < count; ++i) {
            Fragment layer = layerAt(random, random.between(1, 50), random.uniform() * .1, kind == 7);
            for (int c = 0; c < 3; ++c)
              layer.radiance[c] =
                  layer.coverage * (1 - layer.transmission[c]) * hue[c] * (1 + .02f * random.uniformf());
            pixel.push_back(layer);
          }
        }
        if (random.below(10) == 0) pixel[0].coverage = 0;  // light without cover
        if (random.below(10) == 0) pixel[0].transmission.g = .9995f;
      }
      const FragmentLists lists = listsOf(pixels);
      const GBuffer gbuffer = backgroundFor(lists, random);
      Veil veil(lists.window.width(), 1), truth(lists.window.width(), 1);
      MethodChoice choice;
      choice.weight = weightOf(batch % 2 ? shading::PLD_WEIGHT_EQ5 : shading::PLD_WEIGHT_EQ9);
      compositeWithin(lists, choice, gbuffer.data, &gbuffer.beauty, nullptr, tolerance, veil, counts);
      compositeSorted(lists, lists.window, truth);
      for (std::size_t i = 0; i < pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const double behind = static_cast<double>(gbuffer.beauty[i][c]);
          const double x =
              static_cast<double>(veil.light[i][c]) + static_cast<double>(veil.transmission[i][c]) * behind;
          const double y =
              static_cast<double>(truth.light[i][c]) + static_cast<double>(truth.transmission[i][c]) * behind;
          worst = std::max(worst, std::abs(x - y) / std::max(1.0, std::abs(x)));
        }
    }
    printf("[ figure ] tolerance %g: worst error %.5f, %zu certified, %zu recomputed\n", tolerance, worst,
           counts.certified, counts.recomputed);
    EXPECT_LE(worst, tolerance);
    EXPECT_GT(worst, tolerance * .02);   // the test would see a violation
    EXPECT_GT(counts.certified, 1000u);  // and not everything was recomputed
    EXPECT_GT(counts.recomputed, 1000u);
  }
}

TEST(Tolerance, BoundHoldsForEachPixel) {
  Random random(77);
  double tightest = 1e9;
  for (int i = 0; i < 5000; ++i) {
    const FragmentLists lists = listsOf({pixelOfSet("ABCDE"[random.below(5)], random, random.below(2) == 0)});
    std::vector<MethodLayer> layers;
    layersOf(lists, 0, 1e30f, layers);
    const glm::dvec3 bound = errorBound(layers);
    MethodChoice choice;
    choice.weight = weightOf(shading::PLD_WEIGHT_EQ7Z);
    const LayerMix mix = mixWeighted(layers, choice);
    Veil truth(1, 1);
    compositeSorted(lists, lists.window, truth);
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(mix.light[c] - static_cast<double>(truth.light[0][c]));
      ASSERT_LE(error, bound[c]);
      if (error > 1e-3) tightest = std::min(tightest, bound[c] / error);
    }
  }
  printf("[ figure ] the bound is at its tightest %.2f times the error\n", tightest);
  EXPECT_LT(tightest, 3);
}

}  // namespace
}  // namespace pellucid
