// MODEL section 12: finite whatever goes in, and right by `over` where every method must be.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/fold_published.h"
#include "composite/over.h"
#include "composite/resolve.h"
#include "shaders/weights.h"
#include "tests/support/layers.h"

namespace pellucid {
namespace {

using namespace test;

constexpr float kSky = std::numeric_limits<float>::infinity();
constexpr float kCoverages[] = {0.0f, 1e-8f, 0.3f, 1.0f - 1e-7f, 1.0f};
const glm::vec3 kTransmissions[] = {glm::vec3(0), glm::vec3(1), glm::vec3(1, 0, 0.5f), glm::vec3(1.0f - 1e-7f)};
constexpr float kRadiances[] = {0.0f, 1e-30f, 1.0f, 65505.0f, 1e6f};
constexpr float kDepths[] = {1e-6f, 0.01f, 3.0f, 1e4f, 1e9f};
enum class Fold { floats, exact, published };
constexpr Fold kFolds[] = {Fold::floats, Fold::exact, Fold::published};

FragmentLists listOf(std::vector<Fragment> fragments) {
  FragmentLists lists;
  lists.window = {0, 0, 1, 1};
  lists.solid = Image<glm::vec4>(1, 1, glm::vec4(0, 0, 0, kSky));
  lists.offsets = {0, fragments.size()};
  lists.fragments = std::move(fragments);
  return lists;
}

Fragment fragmentOf(float coverage, glm::vec3 transmission, float radiance, float z) {
  Fragment fragment{};
  fragment.coverage = coverage;
  fragment.transmission = transmission;
  // Without coverage the light is additive.
  fragment.radiance = coverage == 0.0f ? glm::vec3(radiance) : coverage * glm::vec3(radiance);
  fragment.z = z;
  return fragment;
}

Veil folded(Fold fold, const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation) {
  const Window window{0, 0, 1, 1};
  OitPlanes planes = fold == Fold::published ? emptyPublishedPlanes(window, window) : emptyPlanes(window, window);
  PublishedClamps clamps;
  if (fold == Fold::floats) foldFragments(lists, weight, normalisation, planes);
  if (fold == Fold::exact) foldExact(lists, weight, normalisation, planes);
  if (fold == Fold::published) foldPublished(lists, weight, planes, clamps);
  return resolve(planes, {});
}

glm::dvec3 over(const Veil& veil, const glm::vec3& background) {
  if (!veil.touched[0]) return glm::dvec3(background);
  return glm::dvec3(veil.light[0]) + glm::dvec3(veil.transmission[0]) * glm::dvec3(background);
}

Veil sorted(const FragmentLists& lists) {
  Veil veil(1, 1);
  compositeSorted(lists, {0, 0, 1, 1}, veil);
  return veil;
}

TEST(Extremes, OneLayerOfEveryKindIsFiniteAndRight) {
  const glm::vec3 background(0.25f, 7.0f, 1e-30f);
  double worst = 0;
  std::size_t cases = 0;
  for (const float coverage : kCoverages)
    for (const glm::vec3& transmission : kTransmissions)
      for (const float radiance : kRadiances)
        for (const float z : kDepths)
          for (const DepthWeight& row : kDepthWeights) {
            const int kind = row.kind;
            const FragmentLists lists = listOf({fragmentOf(coverage, transmission, radiance, z)});
            if (shading::isSolid(coverage, transmission)) continue;  // the solid pass's
            const glm::dvec3 truth = over(sorted(lists), background);
            for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED})
              for (const Fold fold : kFolds) {
                const glm::dvec3 found = over(folded(fold, lists, weightOf(kind), normalisation), background);
                ++cases;
                for (int c = 0; c < 3; ++c) {
                  ASSERT_TRUE(std::isfinite(found[c]) && found[c] >= 0)
                      << "coverage " << coverage << " t " << transmission[c] << " L " << radiance << " z " << z
                      << " weight " << kind << " normalisation " << normalisation;
                  if (normalisation != shading::PLD_NORMALISE_SPECTRAL || fold == Fold::published) continue;
                  const double error = std::abs(found[c] - truth[c]) / std::max(1.0, truth[c]);
                  worst = std::max(worst, error);
                  ASSERT_LE(error, 1e-6) << "coverage " << coverage << " t " << transmission[c] << " L " << radiance
                                         << " z " << z << " weight " << kind;
                }
              }
          }
  std::printf("%zu single layers: all finite; spectral against over, worst %.2g x max(1, value)\n", cases, worst);
}

// Layers of one colour: whatever the weights, the average is that colour, so every tier but the published one must
// equal `over`, from 1 layer to 100,000, coplanar or spread over fifteen decades of depth.
TEST(Extremes, FromOneToAHundredThousandLayers) {
  const glm::vec3 background(0.25f, 7.0f, 0.0f);
  double worst[2] = {0, 0};
  for (const int count : {1, 2, 100, 10000, 100000})
    for (const float coverage : {1e-8f, 1e-4f, 0.5f, 1.0f - 1e-7f})
      for (const bool coplanar : {true, false})
        for (const float radiance : {1e-30f, 1.0f, 1e6f}) {
          std::vector<Fragment> fragments;
          for (int i = 0; i < count; ++i) {
            const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
            const float z = coplanar ? 3.0f : static_cast<float>(std::pow(10.0, -6 + 15 * share));
            fragments.push_back(fragmentOf(coverage, glm::vec3(0), radiance, z));
          }
          const FragmentLists lists = listOf(std::move(fragments));
          const double beta = std::exp(count * std::log1p(-static_cast<double>(coverage)));
          for (const Fold fold : kFolds)
            for (const int kind : {shading::PLD_WEIGHT_EQ5, shading::PLD_WEIGHT_POWER, shading::PLD_WEIGHT_EQ10Z}) {
              const glm::dvec3 found =
                  over(folded(fold, lists, weightOf(kind), shading::PLD_NORMALISE_SPECTRAL), background);
              for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(found[c]) && found[c] >= 0) << count << ' ' << coverage;
                if (fold == Fold::published) continue;
                const double truth =
                    (1 - beta) * static_cast<double>(radiance) + beta * static_cast<double>(background[c]);
                const double error = std::abs(found[c] - truth) / std::max(1.0, truth);
                double& most = worst[fold == Fold::exact ? 1 : 0];
                most = std::max(most, error);
              }
            }
        }
  std::printf("1 to 100,000 layers of one colour against over: worst %.2g (float), %.2g (exact) x max(1, value)\n",
              worst[0], worst[1]);
  // A float sum of n terms is off by at most n 2^-24 of itself: 6e-3 at 100,000 layers.
  EXPECT_LE(worst[0], 100000 * 0x1p-24);
  EXPECT_LE(worst[1], 1e-6);
}

TEST(Extremes, CoincidentLayersAndLayersOnTheBackgroundAreFiniteInAnyOrder) {
  Random random(71);
  for (int turn = 0; turn < 200; ++turn) {
    std::vector<Fragment> fragments;
    for (std::uint32_t i = 0; i < 2 + random.below(6); ++i)
      fragments.push_back(fragmentOf(kCoverages[random.below(4)], kTransmissions[1 + random.below(3)],
                                     kRadiances[random.below(5)], kDepths[turn % 5]));
    const Veil one = folded(Fold::exact, listOf(fragments), weightOf(shading::PLD_WEIGHT_EQ5), 0);
    const Veil truth = sorted(listOf(fragments));
    std::reverse(fragments.begin(), fragments.end());
    const Veil two = folded(Fold::exact, listOf(fragments), weightOf(shading::PLD_WEIGHT_EQ5), 0);
    EXPECT_EQ(one.light[0], two.light[0]);
    EXPECT_EQ(one.transmission[0], two.transmission[0]);
    EXPECT_EQ(truth.light[0], sorted(listOf(fragments)).light[0]);
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(one.light[0][c]) && std::isfinite(truth.light[0][c]));
  }
}

}  // namespace
}  // namespace pellucid
