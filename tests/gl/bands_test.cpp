// How a picture is cut so that each part's fragments fit in memory.
#include <gtest/gtest.h>

#include "engine_bridge/gl/fragment_lists.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

std::size_t countIn(const Image<float>& count, const Window& window) {
  std::size_t sum = 0;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) sum += static_cast<std::size_t>(count.at(x, y));
  return sum;
}

TEST(Bands, WholeRowsWhereTheyFit) {
  const Image<float> count(10, 6, 1.0f);
  const std::vector<Window> bands = gl::bandsOf(count, {0, 0, 10, 6}, 25);
  ASSERT_EQ(bands.size(), 3u);
  EXPECT_EQ(bands[0], (Window{0, 0, 10, 2}));
  EXPECT_EQ(bands[2], (Window{0, 4, 10, 6}));
}

TEST(Bands, EmptyPictureIsOneBand) {
  EXPECT_EQ(gl::bandsOf(Image<float>(10, 6, 0.0f), {0, 0, 10, 6}, 1).size(), 1u);
}

TEST(Bands, HeavyRowsAreCutInXAndHeavyPixelsStandAlone) {
  Image<float> count(4, 3, 1.0f);
  count.at(2, 1) = 100.0f;
  const std::vector<Window> bands = gl::bandsOf(count, {0, 0, 4, 3}, 8);
  const std::vector<Window> expected = {{0, 0, 4, 1}, {0, 1, 2, 2}, {2, 1, 3, 2}, {3, 1, 4, 2}, {0, 2, 4, 3}};
  EXPECT_EQ(bands, expected);
}

TEST(Bands, CoverEveryPixelOnceWithinTheLimit) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Image<float> count(23, 17);
    for (std::size_t i = 0; i < count.size(); ++i)
      count[i] = static_cast<float>(random.below(4) ? random.below(5) : random.below(60));
    const Window area{3, 2, 21, 17};
    const std::size_t most = 1 + random.below(300);
    Image<int> visits(23, 17);
    for (const Window& band : gl::bandsOf(count, area, most)) {
      const bool onePixel = band.width() == 1 && band.height() == 1;
      EXPECT_TRUE(onePixel || countIn(count, band) <= most);
      for (int y = band.y0; y < band.y1; ++y)
        for (int x = band.x0; x < band.x1; ++x) ++visits.at(x, y);
    }
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 23; ++x)
        EXPECT_EQ(visits.at(x, y), x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1 ? 1 : 0);
  }
}

TEST(Bands, RowsOfFewPixels) {
  const std::vector<Window> expected = {{1, 2, 11, 4}, {1, 4, 11, 6}, {1, 6, 11, 7}};
  EXPECT_EQ(gl::rowsOf({1, 2, 11, 7}, 29), expected);
  EXPECT_EQ(gl::rowsOf({1, 2, 11, 7}, 3).size(), 5u);
  EXPECT_EQ(gl::rowsOf({1, 2, 11, 7}, 1000), (std::vector<Window>{{1, 2, 11, 7}}));
  EXPECT_TRUE(gl::rowsOf({1, 2, 11, 2}, 3).empty());
}

TEST(Bands, BlocksAreTilesThatShareALimit) {
  const Image<float> count(10, 6, 1.0f);
  const std::vector<Window> blocks = gl::blocksOf(count, {1, 0, 10, 6}, 4, 28);
  // Two tiles share a block while both fit: 12 + 16, then 8; below, half of that fits in one.
  const std::vector<Window> expected = {{1, 0, 8, 4}, {8, 0, 10, 4}, {1, 4, 10, 6}};
  EXPECT_EQ(blocks, expected);
  EXPECT_EQ(gl::blocksOf(count, {1, 0, 10, 6}, 4, 1).size(), 6u);  // a tile is the least
}

}  // namespace
}  // namespace pellucid::test
