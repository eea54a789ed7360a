// Lists in blocks that a cache holds, and without what compositing by depth does not read: the same fragments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "composite/over.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

constexpr int kEdge = 512;

Stage panes() {
  Stage stage(kEdge, kEdge);
  Material glass = unlitBlend({.2f, .5f, .9f}, .3f);
  glass.transmission = .5f;
  glass.baseColor = {.9f, .6f, .3f, .4f};
  const int tinted = stage.add(glass);
  for (int i = 0; i < 4; ++i) stage.slanted(0, 0, kEdge, kEdge, 2.0 + i, 6.0 - i, tinted);  // they cross
  stage.quad(100, 70, 300, 400, 3.3, stage.add(unlitBlend({.1f, .1f, .1f}, 1.0f)));        // solid
  return stage;
}

struct Pixels {
  std::vector<std::vector<LeanFragment>> pixels{static_cast<std::size_t>(kEdge) * kEdge};
  std::vector<int> visits = std::vector<int>(static_cast<std::size_t>(kEdge) * kEdge, 0);

  template <class Record>
  void add(const ListsOf<Record>& lists) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i) {
        const auto pixel = static_cast<std::size_t>(y * kEdge + x);
        ++visits[pixel];
        for (std::uint64_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) {
          LeanFragment lean;
          std::memcpy(static_cast<void*>(&lean), &lists.fragments[k], sizeof lean);
          pixels[pixel].push_back(lean);
        }
        std::sort(pixels[pixel].begin(), pixels[pixel].end(), [](const LeanFragment& a, const LeanFragment& b) {
          return std::memcmp(&a, &b, sizeof a) < 0;
        });
      }
  }
};

TEST(LeanLists, SameFragmentsAndPictureWithAThirdLess) {
  Stage stage = panes();
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  PassSettings whole;
  whole.tile = kEdge;
  Pixels blocks, rows, lean;
  Veil full(kEdge, kEdge), slim(kEdge, kEdge);
  pass.fragments(whole, [&](const FragmentLists& lists) { rows.add(lists); });
  const std::size_t rowWindows = pass.statistics().tiles, fragments = pass.statistics().fragments;
  pass.fragments({}, [&](const FragmentLists& lists) {
    blocks.add(lists);
    compositeSorted(lists, stage.gbuffer.data, full);
  });
  const std::size_t blockWindows = pass.statistics().tiles;
  EXPECT_EQ(pass.statistics().fragments, fragments);
  pass.leanFragments({}, [&](const LeanLists& lists) {
    lean.add(lists);
    compositeSorted(lists, stage.gbuffer.data, slim);
  });
  EXPECT_EQ(pass.statistics().fragments, fragments);
  printf("[ figure ] %zu fragments: %zu windows by budget alone, %zu that fit the cache, %zu lean ones\n", fragments,
         rowWindows, blockWindows, pass.statistics().tiles);
  EXPECT_EQ(rowWindows, 1u);
  EXPECT_GE(blockWindows, pass.statistics().tiles);
  EXPECT_GT(pass.statistics().tiles, 1u);
  for (std::size_t i = 0; i < rows.pixels.size(); ++i) {
    ASSERT_EQ(rows.visits[i], 1);
    ASSERT_EQ(blocks.visits[i], 1);
    ASSERT_EQ(lean.visits[i], 1);
    for (const Pixels* found : {&blocks, &lean}) {
      ASSERT_EQ(found->pixels[i].size(), rows.pixels[i].size());
      for (std::size_t k = 0; k < rows.pixels[i].size(); ++k)
        ASSERT_EQ(std::memcmp(&found->pixels[i][k], &rows.pixels[i][k], sizeof(LeanFragment)), 0);
    }
    ASSERT_EQ(full.light[i], slim.light[i]);
    ASSERT_EQ(full.transmission[i], slim.transmission[i]);
  }
}

}  // namespace
}  // namespace pellucid::test
