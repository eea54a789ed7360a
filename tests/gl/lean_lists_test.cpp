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
  stage.quad(100, 70, 300, 400, 3.3, stage.add(unlitBlend({.1f, .1f, .1f}, 1.0f)));         // solid
  return stage;
}

struct Pixels {
  std::vector<std::vector<LeanFragment>> pixels{static_cast<std::size_t>(kEdge) * kEdge};
  std::vector<int> visits = std::vector<int>(static_cast<std::size_t>(kEdge) * kEdge, 0);

  static std::pair<std::uint64_t, std::uint64_t> range(const FragmentLists& lists, std::size_t i) {
    return {lists.offsets[i], lists.offsets[i + 1]};
  }
  static std::pair<std::uint64_t, std::uint64_t> range(const LeanLists& lists, std::size_t i) {
    return {lists.ranges[i].begin, lists.ranges[i].begin + lists.ranges[i].count};
  }

  template <class Lists>
  void add(const Lists& lists) {
    std::size_t i = 0;
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x, ++i) {
        const auto pixel = static_cast<std::size_t>(y * kEdge + x);
        ++visits[pixel];
        const auto [begin, end] = range(lists, i);
        for (std::uint64_t k = begin; k < end; ++k) {
          LeanFragment lean;
          std::memcpy(static_cast<void*>(&lean), &lists.fragments[k], sizeof lean);
          pixels[pixel].push_back(lean);
        }
        std::sort(pixels[pixel].begin(), pixels[pixel].end(),
                  [](const LeanFragment& a, const LeanFragment& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
      }
  }
};

// The same fragments on every pixel, each pixel once, and the same picture.
void expectSame(TransparentPass& pass, const PassSettings& settings, const GBuffer& gbuffer, std::size_t& blocks) {
  PassSettings whole;
  whole.tile = kEdge;
  Pixels rows, lean;
  Veil full(kEdge, kEdge), slim(kEdge, kEdge);
  pass.fragments(whole, [&](const FragmentLists& lists) {
    rows.add(lists);
    compositeSorted(lists, gbuffer.data, full);
  });
  const std::size_t fragments = pass.statistics().fragments;
  pass.leanFragments(settings, [&](const LeanLists& lists) {
    lean.add(lists);
    compositeSorted(lists, gbuffer.data, slim);
  });
  blocks = pass.statistics().tiles;
  EXPECT_GT(fragments, 0u);
  EXPECT_EQ(pass.statistics().fragments, fragments);
  for (std::size_t i = 0; i < rows.pixels.size(); ++i) {
    ASSERT_EQ(rows.visits[i], 1);
    ASSERT_EQ(lean.visits[i], 1);
    ASSERT_EQ(lean.pixels[i].size(), rows.pixels[i].size());
    for (std::size_t k = 0; k < rows.pixels[i].size(); ++k)
      ASSERT_EQ(std::memcmp(&lean.pixels[i][k], &rows.pixels[i][k], sizeof(LeanFragment)), 0);
    ASSERT_EQ(full.light[i], slim.light[i]);
    ASSERT_EQ(full.transmission[i], slim.transmission[i]);
  }
}

TEST(LeanLists, SameFragmentsAndPictureInOnePass) {
  Stage stage = panes();
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  std::size_t blocks = 0;
  expectSame(pass, {}, stage.gbuffer, blocks);
  printf("[ figure ] %zu fragments in %zu blocks\n", pass.statistics().fragments, blocks);
  EXPECT_GT(blocks, 1u);
  PassSettings whole;
  whole.tile = kEdge;  // counted first
  expectSame(pass, whole, stage.gbuffer, blocks);
  EXPECT_EQ(blocks, 1u);
}

// Beside nothing, and beside pixels deeper than any block may give to all its pixels: those are counted.
TEST(LeanLists, DeepPixelsAmongShallowOnes) {
  Stage stage(kEdge, kEdge);
  const int smoke = stage.add(unlitBlend({.4f, .5f, .6f}, .05f));
  for (int i = 0; i < 12; ++i) stage.quad(130, 130, 400, 256, 2.0 + i, smoke);
  Stage column(kEdge, kEdge);
  for (int i = 0; i < 300; ++i) column.quad(200, 300, 203, 304, 2.0 + .01 * i, smoke);
  Primitive all;  // one draw
  all.material = smoke;
  for (const Primitive& quad : column.scene.primitives) {
    for (const std::uint32_t index : quad.indices)
      all.indices.push_back(static_cast<std::uint32_t>(all.vertices.size()) + index);
    all.vertices.insert(all.vertices.end(), quad.vertices.begin(), quad.vertices.end());
  }
  stage.place(std::move(all));
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  std::size_t blocks = 0;
  expectSame(pass, {}, stage.gbuffer, blocks);
  EXPECT_GT(blocks, 2u);
  PassSettings little;
  little.budgetBytes = std::size_t{1} << 20;  // no tile with more than a place for each pixel
  std::size_t more = 0;
  expectSame(pass, little, stage.gbuffer, more);
  EXPECT_GT(more, blocks);
}

}  // namespace
}  // namespace pellucid::test
