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
