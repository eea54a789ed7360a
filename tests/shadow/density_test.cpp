// PT17 eqs. 11-13: closed forms and the phenomena that they stand for.
#include <gtest/gtest.h>

#include <cmath>

#include "shaders/shading.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using shading::shadowDensity;

// The same in double precision, from the paper.
double density(double hidden, double cosLight, double eta) {
  const double s = std::min(std::max((1 / eta - 1) / 2, 0.0), 1.0);
  if (s == 0) return hidden;
  const double g = 2 * std::min(std::max(1 - std::pow(cosLight, 128 * s * s), 0.0), 1.0) - 1;
  return std::min(1.0, (1 + g * std::pow(s, .2)) * hidden);
}

TEST(Density, MatchesTheEquationsInDouble) {
  test::Random random(1);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const auto hidden = random.uniformf(), cosine = random.uniformf();
    const auto eta = static_cast<float>(random.between(.3, 1.5));
    const double got = static_cast<double>(shadowDensity(glm::vec3(hidden), cosine, eta).r);
    worst = std::max(worst, std::abs(got - density(hidden, cosine, eta)));
  }
  std::printf("worst of 100,000: %.2g\n", worst);
  EXPECT_LT(worst, 2e-5);  // cos^(128 s^2): the exponent carries the logarithm's 1e-7 up to 128 times
}

TEST(Density, NoRefractionIsThePlainColouredShadow) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 hidden(random.uniformf(), random.uniformf(), random.uniformf());
    EXPECT_EQ(shadowDensity(hidden, random.uniformf(), 1.0f), hidden);
    EXPECT_EQ(shadowDensity(hidden, random.uniformf(), 1.5f), hidden);
  }
}

TEST(Density, CausticIsLighterAtTheCentreDarkerAtTheRimAndMonotone) {
  const glm::vec3 hidden(.5f);
  float centreBefore = .5f, rimBefore = .5f;
  for (const float ior : {1.1f, 1.3f, 1.5f, 1.8f, 2.4f}) {
    const float centre = shadowDensity(hidden, 1.0f, 1.0f / ior).r, rim = shadowDensity(hidden, .05f, 1.0f / ior).r;
    EXPECT_LT(centre, centreBefore) << ior;
    EXPECT_GT(rim, rimBefore) << ior;
    EXPECT_GE(centre, 0.0f);  // never brighter than no shadow
    EXPECT_LE(rim, 1.0f);
    centreBefore = centre;
    rimBefore = rim;
  }
}

TEST(Density, ExtremesStayInRange) {
  for (const float eta : {1e-6f, .01f, .5f, 1.0f, 100.0f})
    for (const float cosine : {0.0f, 1e-30f, .5f, 1.0f})
      for (const float hidden : {0.0f, 1e-30f, .5f, 1.0f}) {
        const float rho = shadowDensity(glm::vec3(hidden), cosine, eta).r;
        EXPECT_GE(rho, 0.0f) << eta << " " << cosine << " " << hidden;
        EXPECT_LE(rho, 1.0f) << eta << " " << cosine << " " << hidden;
      }
}

}  // namespace
}  // namespace pellucid
