// Order in depth by ranks: what sorting gives, for every number of layers that it takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "composite/depth_order.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

TEST(DepthOrder, IsWhatSortingGives) {
  Random random(3);
  for (std::size_t count = 0; count <= kMostRanked; ++count)
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<float> z(count);
      for (float& depth : z) depth = .001f + 1000.0f * random.uniformf();
      std::vector<std::uint32_t> sorted(count), order(count);
      std::iota(sorted.begin(), sorted.end(), 0u);
      std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) { return z[a] < z[b]; });
      bool ties = false;
      for (std::size_t i = 1; i < count; ++i) ties |= z[sorted[i]] == z[sorted[i - 1]];
      ASSERT_EQ(orderByDepth(z.data(), count, order.data()), !ties);
      if (!ties) {
        ASSERT_EQ(order, sorted);
      }
    }
}

TEST(DepthOrder, RefusesTiesAndWhatIsNotANumber) {
  Random random(4);
  std::vector<std::uint32_t> order(kMostRanked);
  for (std::size_t count = 2; count <= kMostRanked; ++count)
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        std::vector<float> z(count);
        for (std::size_t i = 0; i < count; ++i) z[i] = static_cast<float>((i * 7 + 3) % 37);  // all different
        z[a] = z[b];
        EXPECT_FALSE(orderByDepth(z.data(), count, order.data()));
        z[a] = NAN;
        EXPECT_FALSE(orderByDepth(z.data(), count, order.data()));
      }
}

}  // namespace
}  // namespace pellucid::test
