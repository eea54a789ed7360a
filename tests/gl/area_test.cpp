// Passes over a part of the picture: they draw and list there what passes over all of it do, and the part that a scene
// is said to show in holds all that it draws.
#include <gtest/gtest.h>

#include <cstring>

#include "engine_bridge/scene/screen_bounds.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kAreaWidth = 160, kAreaHeight = 120;

Stage stageOf(Random& random, bool orthographic) {
  Stage stage(kAreaWidth, kAreaHeight);
  stage.camera.orthographic = orthographic;
  Material glass = unlitBlend(glm::vec3(0.2f, 0.6f, 0.9f), 0.4f);
  Material solid = unlitBlend(glm::vec3(0.9f), 1.0f);
  const int materials[] = {stage.add(glass), stage.add(glass), stage.add(solid)};
  for (int i = 0; i < 6; ++i) {
    const double x = random.between(20, 100), y = random.between(15, 80);
    stage.slanted(x, y, x + random.between(1, 50), y + random.between(1, 30), random.between(2, 9),
                  random.between(2, 9), materials[i % 3]);
  }
  return stage;
}

template <class Texel>
bool sameBits(const Texel& a, const Texel& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(PassArea, SumsAreThoseOfTheWholePicture) {
  Random random(5);
  for (int round = 0; round < 4; ++round) {
    Stage stage = stageOf(random, round % 2 == 1);
    PassSettings settings;
    settings.sample = {random.uniform(), random.uniform()};
    const OitPlanes whole = stage.accumulate(settings);
    settings.area = {31, 17, 121, 90};
    const OitPlanes part = stage.accumulate(settings);
    ASSERT_EQ(part.data, settings.area);
    for (int y = 17; y < 90; ++y)
      for (int x = 31; x < 121; ++x) {
        ASSERT_TRUE(sameBits(part.at(x - 31, y - 17), whole.at(x, y))) << x << ", " << y;
        ASSERT_TRUE(sameBits(part.solid.at(x - 31, y - 17), whole.solid.at(x, y)));
        ASSERT_EQ(part.frontZ.at(x - 31, y - 17), whole.frontZ.at(x, y));
      }
  }
}

// Fragments of a pixel, in no order.
std::vector<std::vector<float>> depthsOf(Stage& stage, const PassSettings& settings, bool lean) {
  std::vector<std::vector<float>> depths(kAreaWidth * kAreaHeight);
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  const auto add = [&](const Window& window, std::size_t pixel, float z) {
    const int width = window.width(), i = static_cast<int>(pixel);
    depths[static_cast<std::size_t>((window.y0 + i / width) * kAreaWidth + window.x0 + i % width)].push_back(z);
  };
  if (lean)
    pass.leanFragments(settings, [&](const LeanLists& lists) {
      for (std::size_t p = 0; p < lists.ranges.size(); ++p)
        for (std::uint32_t i = 0; i < lists.ranges[p].count; ++i)
          add(lists.window, p, lists.fragments[lists.ranges[p].begin + i].z);
    });
  else
    pass.fragments(settings, [&](const FragmentLists& lists) {
      for (std::size_t p = 0; p + 1 < lists.offsets.size(); ++p)
        for (std::uint64_t i = lists.offsets[p]; i < lists.offsets[p + 1]; ++i)
          add(lists.window, p, lists.fragments[i].z);
    });
  for (std::vector<float>& one : depths) std::sort(one.begin(), one.end());
  return depths;
}

TEST(PassArea, ListsAreThoseOfTheWholePicture) {
  Random random(6);
  for (const bool lean : {false, true})
    for (const int tile : {0, 37}) {
      Stage stage = stageOf(random, false);
      PassSettings settings;
      settings.tile = tile;
      const auto whole = depthsOf(stage, settings, lean);
      settings.area = {41, 22, 117, 77};
      const auto part = depthsOf(stage, settings, lean);
      for (int y = 0; y < kAreaHeight; ++y)
        for (int x = 0; x < kAreaWidth; ++x) {
          const bool inside = x >= 41 && x < 117 && y >= 22 && y < 77;
          const auto pixel = static_cast<std::size_t>(y * kAreaWidth + x);
          ASSERT_EQ(part[pixel], inside ? whole[pixel] : std::vector<float>()) << x << ", " << y;
        }
    }
}

TEST(PassArea, BoundsHoldWhateverAnySampleMeets) {
  Random random(7);
  for (int round = 0; round < 6; ++round) {
    Stage stage = stageOf(random, round % 2 == 1);
    const Window bounds = screenBounds(stage.scene, stage.camera, stage.gbuffer);
    EXPECT_LT(bounds.width() * bounds.height(), kAreaWidth * kAreaHeight);
    for (const glm::dvec2 sample : {glm::dvec2(0.0), glm::dvec2(0.999), glm::dvec2(0.5)}) {
      PassSettings settings;
      settings.sample = sample;
      const auto depths = depthsOf(stage, settings, false);
      for (int y = 0; y < kAreaHeight; ++y)
        for (int x = 0; x < kAreaWidth; ++x)
          if (!depths[static_cast<std::size_t>(y * kAreaWidth + x)].empty()) {
            ASSERT_TRUE(x >= bounds.x0 && x < bounds.x1 && y >= bounds.y0 && y < bounds.y1) << x << ", " << y;
          }
    }
  }
}

TEST(PassArea, BehindTheEyeNothingIsBounded) {
  Stage stage(kAreaWidth, kAreaHeight);
  stage.slanted(10, 10, 20, 20, 3.0, 3.0, stage.add(unlitBlend(glm::vec3(0.5f), 0.5f)));
  EXPECT_LT(screenBounds(stage.scene, stage.camera, stage.gbuffer).width(), 20);
  stage.scene.primitives[0].vertices[0].position.z = 1.0f;
  EXPECT_EQ(screenBounds(stage.scene, stage.camera, stage.gbuffer), stage.gbuffer.data);
  // What lies there altogether is never seen.
  for (Vertex& vertex : stage.scene.primitives[0].vertices) vertex.position.z = 1.0f;
  EXPECT_EQ(screenBounds(stage.scene, stage.camera, stage.gbuffer).width(), 1);
}

}  // namespace
}  // namespace pellucid::test
