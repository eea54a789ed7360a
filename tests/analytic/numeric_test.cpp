#include <gtest/gtest.h>

#include <cmath>

#include "shaders/shading.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using test::Random;

TEST(Numeric, LogWithinItsBound) {
  double worst = 0;
  Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const float x = static_cast<float>(std::exp(random.between(-80, 80)));
    const double truth = std::log(static_cast<double>(x));
    worst =
        std::max(worst, std::abs(static_cast<double>(shading::pldLog(x)) - truth) / std::max(std::abs(truth), 0.25));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 4e-7);  // the bound stated on pldLog
}

TEST(Numeric, ExpWithinItsBound) {
  double worst = 0;
  Random random(2);
  for (int i = 0; i < 200000; ++i) {
    const float x = static_cast<float>(random.between(-87, 88));
    const double truth = std::exp(static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(shading::pldExp(x)) / truth - 1));
  }
  EXPECT_LT(worst, 3e-7);  // seven terms and one rounding of each operation
  EXPECT_EQ(shading::pldExp(-104.0f), 0.0f);
  EXPECT_EQ(shading::pldExp(0.0f), 1.0f);
  EXPECT_TRUE(std::isfinite(shading::pldExp(1e30f)));
}

// The bounds stated on pldLog2, pldExp2 and, where both are at their worst, a power as weights take it.
TEST(Numeric, PowersWithinTheirBounds) {
  double log2 = 0, exp2 = 0, power = 0;
  Random random(5);
  for (int i = 0; i < 200000; ++i) {
    const float x = static_cast<float>(std::exp(random.between(-80, 80))),
                y = static_cast<float>(random.between(-126, 126));
    const double truth = std::log2(static_cast<double>(x));
    log2 = std::max(log2, std::abs(static_cast<double>(shading::pldLog2(x)) - truth) / std::max(std::abs(truth), 4.0));
    exp2 = std::max(exp2, std::abs(static_cast<double>(shading::pldExp2(y)) / std::exp2(static_cast<double>(y)) - 1));
    const float z = static_cast<float>(std::pow(10.0, random.between(-2, 4))),
                k = static_cast<float>(random.between(0, 4));
    const double weight = std::pow(static_cast<double>(z), static_cast<double>(-k));
    if (weight > 2e-12 && weight < 5e11)
      power = std::max(power, std::abs(static_cast<double>(shading::weightPower(z, k)) / weight - 1));
  }
  printf("[ figure ] log2: worst error %.2g of the larger of 4 and the value; exp2: %.2g; z^-k, 1e-12 to 1e12: %.2g\n",
         log2, exp2, power);
  EXPECT_LT(log2, 7.5e-8);
  EXPECT_LT(exp2, 2e-7);
  EXPECT_LT(power, 5e-6);  // a rounding of the exponent, up to 40, times ln 2
  EXPECT_EQ(shading::pldPow(0.5f, 200.0f), 0.0f);
  EXPECT_EQ(shading::pldPow(7.0f, 0.0f), 1.0f);
  EXPECT_TRUE(std::isfinite(shading::pldPow(1e30f, 1e30f)));
  EXPECT_LE(shading::weightPower(1e-30f, 10.0f), 1e12f);
  EXPECT_GE(shading::weightPower(1e30f, 10.0f), 1.2e-26f);  // 2^-86
}

TEST(Numeric, OneMinusExpKeepsThinLayers) {
  double worst = 0;
  Random random(3);
  for (int i = 0; i < 200000; ++i) {
    const float x = static_cast<float>(std::pow(10.0, random.between(-9, 2)));
    const double truth = -std::expm1(-static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(shading::pldOneMinusExp(x)) / truth - 1));
  }
  EXPECT_LT(worst, 4e-7);  // relative, from 1e-9 to 100
  EXPECT_EQ(shading::pldOneMinusExp(0.0f), 0.0f);
  EXPECT_EQ(shading::pldOneMinusExp(shading::PLD_OPAQUE_DEPTH), 1.0f);
}

TEST(Numeric, OpticalDepthAndBackIsTheOpacity) {
  double worst = 0;
  Random random(4);
  for (int i = 0; i < 200000; ++i) {
    const float opacity = static_cast<float>(i % 2 ? random.uniform() : std::pow(10.0, random.between(-7, 0)));
    const double back = static_cast<double>(shading::pldOneMinusExp(shading::opticalDepth(opacity, 1.0f - opacity)));
    worst = std::max(worst, std::abs(back / static_cast<double>(opacity) - 1));
  }
  printf("[ figure ] 1 - beta of one layer, opacity 1e-7..1: worst relative error %.2g\n", worst);
  EXPECT_LT(worst, 6e-7);
  EXPECT_EQ(shading::opticalDepth(1.0f, 0.0f), shading::PLD_OPAQUE_DEPTH);
  EXPECT_EQ(shading::opticalDepth(0.0f, 1.0f), 0.0f);
}

}  // namespace
}  // namespace pellucid
