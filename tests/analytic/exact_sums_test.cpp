// The sums of the exact tier: the true sum of the terms, rounded to float once, whatever their order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "shaders/exact_sums.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

float summed(const std::vector<float>& terms) {
  float largest = 0;
  for (const float term : terms) largest = std::max(largest, std::abs(term));
  shading::ExactSums sums = shading::exactSums(glm::vec4(largest, 0, 0, 0), static_cast<glm::uint>(terms.size()));
  for (const float term : terms) sums = shading::addedTo(sums, glm::vec4(term, 0, 0, 0));
  return shading::roundedSums(sums).x;
}

// Without any rounding, as doubles that do not overlap (Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997),
// the largest last; then to the nearest float, ties to even.
float trueSum(const std::vector<float>& terms) {
  std::vector<double> parts;
  for (const float term : terms) {
    double x = static_cast<double>(term);
    std::size_t kept = 0;
    for (double y : parts) {
      if (std::abs(x) < std::abs(y)) std::swap(x, y);
      const double high = x + y, low = y - (high - x);
      if (low != 0) parts[kept++] = low;
      x = high;
    }
    parts.resize(kept);
    if (x != 0) parts.push_back(x);
  }
  if (parts.empty()) return 0;
  const double sum = parts.back(), rest = parts.size() > 1 ? parts[parts.size() - 2] : 0.0;
  const auto nearest = static_cast<float>(sum);
  const float other = std::nextafterf(nearest, sum > static_cast<double>(nearest) ? INFINITY : -INFINITY);
  if (sum != 0.5 * (static_cast<double>(nearest) + static_cast<double>(other)) || rest == 0.0) return nearest;
  return rest > 0.0 ? std::max(nearest, other) : std::min(nearest, other);
}

bool sameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(ExactSums, RandomTermsOverTwentyDecadesGiveTheTrueSumInAnyOrder) {
  Random random(41);
  std::size_t off = 0, moved = 0, plain = 0;
  constexpr int kCases = 20000;
  for (int i = 0; i < kCases; ++i) {
    std::vector<float> terms(1 + random.below(i % 100 == 0 ? 5000 : 30));
    const bool isSigned = random.below(2);
    for (float& term : terms) {
      term = random.below(4) ? static_cast<float>(std::pow(10.0, random.between(-10, 10)))
                             : std::ldexp(1.0f, static_cast<int>(random.below(60)) - 30);  // those that end in ties
      if (isSigned && random.below(2)) term = -term;
    }
    const float truth = trueSum(terms), found = summed(terms);
    off += !sameBits(truth, found);
    float inTurn = 0;
    for (const float term : terms) inTurn += term;
    plain += !sameBits(truth, inTurn);
    for (std::size_t k = terms.size(); k > 1; --k)
      std::swap(terms[k - 1], terms[random.below(static_cast<std::uint32_t>(k))]);
    moved += !sameBits(found, summed(terms));
  }
  std::printf("%d sums: %zu are not the true sum rounded (added in float: %zu), %zu change with the order\n", kCases,
              off, plain, moved);
  EXPECT_EQ(off, 0u);
  EXPECT_EQ(moved, 0u);
  EXPECT_GT(plain, kCases / 4u);
}

// 1 + 2^-24 lies between two floats: what comes after decides, however small.
TEST(ExactSums, TiesAreDecidedByWhatIsLeft) {
  const float half = 0x1p-24f;
  EXPECT_EQ(summed({1.0f, half}), 1.0f);
  for (const float little : {0x1p-50f, 0x1p-60f, 0x1p-90f}) {
    EXPECT_EQ(summed({1.0f, half, little}), 1.0f + 0x1p-23f);
    EXPECT_EQ(summed({little, 1.0f, half, -2 * little}), 1.0f);
    EXPECT_EQ(summed({-1.0f, -half, -little}), -1.0f - 0x1p-23f);
  }
  EXPECT_EQ(summed({1.0f + 0x1p-23f, half}), 1.0f + 0x1p-22f);
  EXPECT_EQ(summed({1.0f + 0x1p-23f, half, -0x1p-80f}), 1.0f + 0x1p-23f);
}

TEST(ExactSums, TheEndsOfFloats) {
  const float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::min();
  EXPECT_EQ(summed({0.0f, -0.0f}), 0.0f);
  EXPECT_EQ(summed({most}), most);
  EXPECT_EQ(summed({most, most, -most}), most);
  EXPECT_EQ(summed({most, most}), INFINITY);
  EXPECT_EQ(summed({least}), least);
  EXPECT_EQ(summed({least, least, -least}), least);
  EXPECT_EQ(summed({1e25f, -1e25f, 3.0f}), 3.0f);
  EXPECT_EQ(summed(std::vector<float>(100000, 0.1f)), static_cast<float>(100000 * static_cast<double>(0.1f)));
}

}  // namespace
}  // namespace pellucid::test
