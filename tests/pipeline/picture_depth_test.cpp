// What is known of a picture's depth grows ahead of things that move, and is the same as what all of it tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "composite/pipeline/picture_depth.h"

namespace pellucid {
namespace {

constexpr int kWidth = 240, kHeight = 60;

// Posts before a tilted wall; a post's left side is filtered over half a pixel.
GBuffer posts() {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {7, 5, 7 + kWidth, 5 + kHeight};
  gbuffer.beauty = Image<glm::vec4>(kWidth, kHeight);
  gbuffer.viewZ = Image<float>(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int within = x % 24;
      const float post = within == 10 ? 0.5f : within > 10 && within < 18 ? 1.0f : 0.0f;
      gbuffer.beauty.at(x, y) = glm::vec4(0.2f + 0.6f * post, 0.3f, 0.9f - 0.8f * post, 1.0f);
      gbuffer.viewZ.at(x, y) = post >= 0.5f ? 2.0f : 5.0f + 0.01f * static_cast<float>(y);
    }
  return gbuffer;
}

bool isSame(const EdgePixel& a, const EdgePixel& b) {
  return a.x == b.x && a.y == b.y && a.share == b.share && a.nearerPart == b.nearerPart && a.whole == b.whole &&
         a.towardsNearer == b.towardsNearer;
}

TEST(PictureDepth, GrowsAheadOfWhatMoves) {
  const GBuffer gbuffer = posts();
  const Camera camera;
  const std::vector<EdgePixel> all = edgePixels(gbuffer, DepthPlanes(gbuffer, camera));
  ASSERT_GT(all.size(), 500u);
  Journal journal;
  PictureDepth depth;
  Window known, area{7 + 20, 5 + 10, 7 + 60, 5 + 50};
  int grew = 0;
  for (int frame = 0; frame < 150; ++frame, ++area.x0, ++area.x1) {
    const std::vector<EdgePixel>& edges = depth.edges(gbuffer, camera, area, journal);
    const DepthPlanes& planes = depth.planes(gbuffer, camera, area, journal);
    if (!(planes.part() == known)) ++grew;
    known = planes.part();
    for (const EdgePixel& edge : all) {
      const bool asked = edge.x + 7 >= area.x0 && edge.x + 7 < area.x1 && edge.y + 5 >= area.y0 && edge.y + 5 < area.y1;
      if (!asked) continue;
      EXPECT_TRUE(std::any_of(edges.begin(), edges.end(), [&](const EdgePixel& own) { return isSame(own, edge); }))
          << frame << ": " << edge.x << " " << edge.y;
    }
    EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end(), [](const EdgePixel& a, const EdgePixel& b) {
      return a.y != b.y ? a.y < b.y : a.x < b.x;
    }));
  }
  EXPECT_LE(grew, 8) << "of 150 frames; a pixel a frame";
}

}  // namespace
}  // namespace pellucid
