// MODEL sections 2 and 3: the shared text against closed forms and against the unshared reference.
#include <gtest/gtest.h>

#include <cmath>

#include "shaders/weights.h"
#include "tests/support/layers.h"

namespace pellucid {
namespace {

using namespace test;
using reference::Layer;
using reference::Rgb;

double edgy(Random& random) {  // 0 and 1 among them
  const std::uint32_t k = random.below(8);
  return k == 0 ? 0.0 : k == 1 ? 1.0 : random.uniform();
}

Layer randomLayer(Random& random, bool emission) {
  Layer layer;
  layer.coverage = edgy(random);
  for (std::size_t c = 0; c < 3; ++c) {
    layer.transmission[c] = edgy(random);
    layer.reflected[c] = random.below(4) == 0 ? 100.0 * random.uniform() : random.uniform();
    layer.additive[c] = emission ? random.uniform() * 4.0 : 0.0;
  }
  layer.z = std::pow(10.0, random.between(-2, 3));
  return rounded(layer);
}

TEST(Resolve, OneSpectralLayerIsOver) {
  double worst = 0;
  for (const DepthWeight& row : kDepthWeights) {
    const int kind = row.kind;
    Random random(17);
    for (int i = 0; i < 10000; ++i) {
      const Layer layer = randomLayer(random, random.below(2) == 0);
      const Rgb background{random.uniformf(), random.uniformf(), random.below(4) ? random.uniformf() : 50.0f};
      const Rgb truth = reference::sortedOver({layer}, background);
      const glm::vec3 ours = resolveLayers({layer}, weightOf(kind), shading::PLD_NORMALISE_SPECTRAL,
                                           glm::vec3(background[0], background[1], background[2]));
      for (int c = 0; c < 3; ++c) {
        const double t = truth[static_cast<std::size_t>(c)];
        const double error = std::abs(static_cast<double>(ours[c]) - t) / std::max(1.0, t);
        worst = std::max(worst, error);
        ASSERT_LE(error, 1e-6) << "weight " << kind << " layer " << i << " channel " << c << ": found " << ours[c]
                               << ", expected " << t;
      }
    }
  }
  printf("[ figure ] n = 1, spectral against over: worst error %.2g x max(1, value)\n", worst);
}

TEST(Resolve, RedGlassBothWays) {
  Layer glass;
  glass.coverage = 1;
  glass.transmission = {.9, .1, .1};
  glass.reflected = {.2, .2, .2};
  glass.z = 2;
  const auto weight = weightOf(shading::PLD_WEIGHT_EQ5);
  const glm::vec3 background(0.5f);
  const glm::vec3 spectral = resolveLayers({glass}, weight, shading::PLD_NORMALISE_SPECTRAL, background);
  const glm::vec3 published = resolveLayers({glass}, weight, shading::PLD_NORMALISE_PUBLISHED, background);
  EXPECT_NEAR(spectral.r, 0.65, 1e-6);
  EXPECT_NEAR(spectral.g, 0.25, 1e-6);
  EXPECT_NEAR(spectral.b, 0.25, 1e-6);
  EXPECT_NEAR(published.r, 0.45 + 0.1 * 0.2 / 0.6333333, 1e-5);  // beta b + (1 - beta) L_r / (1 - mean t)
  EXPECT_NEAR(published.g, 0.05 + 0.9 * 0.2 / 0.6333333, 1e-5);
  EXPECT_NEAR(published.r, 0.48, 5e-3);  // as MODEL prints them
  EXPECT_NEAR(published.g, 0.33, 5e-3);

  glass.transmission = {1, 1, 1};  // clear: the highlight must survive, and does not in the published form
  EXPECT_NEAR(resolveLayers({glass}, weight, shading::PLD_NORMALISE_SPECTRAL, background).r, 0.7, 1e-6);
  EXPECT_NEAR(resolveLayers({glass}, weight, shading::PLD_NORMALISE_PUBLISHED, background).r, 0.5, 1e-6);
}

TEST(Resolve, TenThousandThinLayers) {
  std::vector<Layer> layers(10000);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].coverage = .0009;
    layers[i].reflected = {.5, .25, 1.};
    layers[i].z = 1.0 + 1e-4 * static_cast<double>(i);
    layers[i] = rounded(layers[i]);
  }
  const Rgb truth = reference::sortedOver(layers, {1, 1, 1});
  const glm::vec3 ours =
      resolveLayers(layers, weightOf(shading::PLD_WEIGHT_EQ7Z), shading::PLD_NORMALISE_SPECTRAL, glm::vec3(1.0f));
  double worst = 0;
  for (int c = 0; c < 3; ++c)
    worst = std::max(worst, std::abs(static_cast<double>(ours[c]) / truth[static_cast<std::size_t>(c)] - 1));
  printf("[ figure ] 10,000 layers of coverage .0009: worst relative error %.2g\n", worst);
  EXPECT_LE(worst, 1e-3);
}

TEST(Scattering, BetaAgainstTheProductInDouble) {
  // Total optical depths up to 10: beyond, beta itself is below what a picture shows.
  const struct {
    int layers;
    double bound;
  } cases[] = {{1, 1e-5}, {10, 1e-5}, {100, 1e-5}, {1000, 1e-3}, {10000, 1e-3}};
  for (const auto& [count, bound] : cases) {
    double worst = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed);
      const double total = random.between(0.01, 10);
      float depth = 0;
      double beta = 1;
      for (int i = 0; i < count; ++i) {
        const double share = total / count * 2 * random.uniform();
        const float opacity = static_cast<float>(-std::expm1(-share));
        depth += shading::opticalDepth(opacity, 1.0f - opacity);
        beta *= 1.0 - static_cast<double>(opacity);
      }
      worst = std::max(worst, std::abs(static_cast<double>(shading::pldExp(-depth)) / beta - 1));
    }
    printf("[ figure ] beta, %5d layers: worst relative error %.2g (bound %.0e)\n", count, worst, bound);
    EXPECT_LE(worst, bound) << count << " layers";
  }
}

TEST(Scattering, OneMinusBetaOfOneThinLayer) {
  for (const double opacity : {1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, .1, .3, .9, 1. - 1e-7}) {
    const float o = static_cast<float>(opacity);
    const glm::vec3 depth = shading::opticalDepth3(glm::vec3(o), glm::vec3(1.0f - o));
    const double found = static_cast<double>(shading::netOpacityOf(depth, shading::transmittanceOf(depth)).r);
    EXPECT_NEAR(found / static_cast<double>(o), 1.0, 1e-5) << opacity;
  }
}

TEST(Resolve, AdditiveLightSurvives) {
  Layer fire;
  fire.additive = {3, 2, 1};
  fire.z = 5;
  const auto weight = weightOf(shading::PLD_WEIGHT_EQ5);
  for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED}) {
    const glm::vec3 alone = resolveLayers({fire}, weight, normalisation, glm::vec3(.25f));
    EXPECT_EQ(alone, glm::vec3(3.25f, 2.25f, 1.25f));
  }
}

TEST(Resolve, AdditiveLightBehindSmokeIsAttenuated) {
  Layer fire, smoke;
  fire.additive = {4, 4, 4};
  fire.z = 40;
  smoke.coverage = .8;
  smoke.reflected = {.5, .5, .5};
  smoke.z = 2;
  for (const DepthWeight& row : kDepthWeights) {
    const int kind = row.kind;
    const float lit = resolveLayers({fire, smoke}, weightOf(kind), shading::PLD_NORMALISE_SPECTRAL, glm::vec3(0.0f)).r;
    const double truth = reference::sortedOver({fire, smoke}, {0, 0, 0})[0];
    EXPECT_GE(lit, truth - 1e-5) << kind;  // the light is never taken for farther than everything
    EXPECT_LE(lit, 4.4 - (kind == shading::PLD_WEIGHT_UNIFORM ? 1.5 : 1.0)) << kind;
    std::swap(fire.z, smoke.z);
    const float front =
        resolveLayers({fire, smoke}, weightOf(kind), shading::PLD_NORMALISE_SPECTRAL, glm::vec3(0.0f)).r;
    EXPECT_GE(front, lit - 1e-5f) << kind;
    std::swap(fire.z, smoke.z);
  }
}

TEST(Resolve, SelfModulationIsTheUnbiasedForm) {
  const glm::vec3 dark = shading::selfModulation(glm::vec3(0.0f));
  EXPECT_EQ(dark, glm::vec3(1.0f));  // tends to 1, not to 1/2
  const glm::vec3 red = shading::selfModulation(glm::vec3(.8f, .2f, .2f));
  EXPECT_NEAR(red.r, 1.0, 1e-6);
  EXPECT_NEAR(red.g, .5 + .2 / 1.6, 1e-6);
}

TEST(Weight, DocumentedValues) {
  // WB13 eqs. 7-10 and PT17 eq. 5, in double, at twenty depths.
  for (int i = 0; i < 20; ++i) {
    const float z = static_cast<float>(std::pow(10.0, -1.0 + 0.19 * i));
    const double d = static_cast<double>(z);
    const auto limited = [](double w, double low, double high) { return std::min(std::max(w, low), high); };
    const double eq7 = limited(10 / (1e-5 + std::pow(d / 5, 2) + std::pow(d / 200, 6)), 1e-2, 3e3);
    const double eq8 = limited(10 / (1e-5 + std::pow(d / 10, 3) + std::pow(d / 200, 6)), 1e-2, 3e3);
    const double eq9 = limited(.03 / (1e-5 + std::pow(d / 200, 4)), 1e-2, 3e3);
    const double window = limited((0.1 * 500 / d - 500) / (0.1 - 500), 0, 1);
    const double eq10 = std::max(1e-2, 3e3 * std::pow(1 - window, 3));
    const double eq5 = limited(std::pow(10 * (1 - .99 * window) * .4, 3), .01, 30);
    const auto ours = [&](int kind) {
      return static_cast<double>(shading::layerWeight(weightOf(kind, 0.1f, 500.0f), z, 0.4f));
    };
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ7Z) / eq7, 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ8Z) / eq8, 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ9Z) / eq9, 1, 1e-5) << z;
    // 1 - d cancels: at the far end of the range one ulp of d is 1e-4 of 1 - d, cubed.
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ10Z), eq10, 1e-3 * eq10 + 1e-6) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ7) / (.4 * eq7), 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ10), .4 * eq10, 1e-3 * eq10 + 1e-6) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_EQ5) / eq5, 1, 1e-4) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_POWER) / std::pow(d, -3), 1, 1e-5) << z;
    EXPECT_EQ(ours(shading::PLD_WEIGHT_UNIFORM), 1.0);
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_FIG1) * std::pow(d + 5, 2), 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_FIG6) / (.4 * .4 * std::pow(d, -6)), 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_FIG10) / (10 / (1 + 10 * std::pow(3 * d, 5))), 1, 1e-5) << z;
    EXPECT_NEAR(ours(shading::PLD_WEIGHT_LINEAR), std::max((500 - d) / (500 - .1), 0.0) + 1e-3, 1e-6) << z;
  }
}

// In another unit every weight that has a reference is the same where the reference grows with it; a power has the same
// ratios over any reference.
TEST(Weight, HasNoScaleOverItsReference) {
  for (const DepthWeight& row : kDepthWeights) {
    if (row.reference == WeightReference::none) continue;
    for (const float scale : {1e-3f, 0.5f, 1e3f})
      for (const float exponent : {0.5f, 3.0f, 32.0f})
        for (float z = 1.0f; z < 6.0f; z *= 1.3f) {
          shading::WeightSettings here = weightOf(row.kind, 0.1f, 1000.0f, exponent), there = here;
          there.reference = scale;
          const auto ratio = [&](const shading::WeightSettings& weight, float unit) {
            return static_cast<double>(shading::depthWeight(weight, unit * z)) /
                   static_cast<double>(shading::depthWeight(weight, unit * 1.0f));
          };
          // A rounding of depth, to the power of 32.
          EXPECT_NEAR(ratio(there, scale) / ratio(here, 1.0f), 1.0, 1e-5) << row.name << " at " << z << " x " << scale;
          there.reference = 0.5f;
          // Over half the reference, powers of 32 end at their floor of 2^-86 beyond 3.2 m.
          const bool floored = exponent * std::log2(2.0f * z) > 86.0f;
          if (row.reference == WeightReference::unit || floored) continue;
          EXPECT_NEAR(ratio(there, 1.0f) / ratio(here, 1.0f), 1.0, 1e-5) << row.name << " at " << z;
        }
  }
}

TEST(Weight, FallsWithDepthAndStaysFinite) {
  for (const DepthWeight& row : kDepthWeights) {
    const int kind = row.kind;
    float last = std::numeric_limits<float>::infinity();
    for (double exponent = -6; exponent <= 9; exponent += 0.125) {
      const float w = shading::depthWeight(weightOf(kind), static_cast<float>(std::pow(10.0, exponent)));
      EXPECT_TRUE(std::isfinite(w) && w > 0) << kind << " at 1e" << exponent;
      EXPECT_LE(w, last) << kind << " at 1e" << exponent;
      last = w;
    }
  }
}

TEST(Surface, FresnelOfGlassAtNormalAndGrazing) {
  EXPECT_NEAR(shading::fresnelDielectric(1.0f, 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(shading::fresnelDielectric(0.0f, 1.5f), 1.0, 1e-6);
  EXPECT_EQ(shading::fresnelDielectric(0.3f, 1.0f), 0.0f);
  // Brewster's angle: the parallel part vanishes, half of the perpendicular one is left.
  const double brewster = std::cos(std::atan(1.5));
  const double perpendicular = (1 - 2.25) / (1 + 2.25);
  EXPECT_NEAR(shading::fresnelDielectric(static_cast<float>(brewster), 1.5f), .5 * perpendicular * perpendicular, 1e-6);
}

TEST(Surface, RimIsOnePixelWideAndCentredOnTheCut) {
  EXPECT_EQ(shading::rimCoverage(0.5f, 0.5f, 0.1f), 0.5f);
  EXPECT_EQ(shading::rimCoverage(0.55f, 0.5f, 0.1f), 1.0f);
  EXPECT_EQ(shading::rimCoverage(0.45f, 0.5f, 0.1f), 0.0f);
  EXPECT_EQ(shading::rimCoverage(1.0f, 0.5f, 0.0f), 1.0f);
  EXPECT_EQ(shading::rimCoverage(1.0f, 1.0f, 0.0f), 1.0f);  // glTF: alpha at the cutoff is covered
  EXPECT_EQ(shading::rimCoverage(0.4f, 0.5f, 0.0f), 0.0f);
}

}  // namespace
}  // namespace pellucid
