// Cut-outs whose pattern is finer than the pixels: their levels, and the occlusion of what is partly covered.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine_bridge/scene/foliage.h"
#include "engine_bridge/scene/mask_levels.h"
#include "tests/occlusion/leaf_stage.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;

Image<glm::vec4> drawn(int width, int height, const std::function<float(int, int)>& alpha) {
  Image<glm::vec4> texels(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) texels.at(x, y) = glm::vec4(0.2f, 0.6f, 0.1f, alpha(x, y));
  return texels;
}

Image<glm::vec4> noise(float covered) {
  Random random(11);
  return drawn(256, 256, [&](int, int) { return random.uniformf() < covered ? 1.0f : 0.0f; });
}

Image<glm::vec4> discs(double radius) {
  return drawn(256, 256, [=](int x, int y) { return std::hypot(x % 16 - 7.5, y % 16 - 7.5) < radius ? 1.0f : 0.0f; });
}

double meanAlpha(const Image<glm::vec4>& level) {
  double sum = 0.0;
  for (std::size_t i = 0; i < level.size(); ++i) sum += static_cast<double>(level[i].a);
  return sum / static_cast<double>(level.size());
}

// Leaves keep their shape far down; what repeats in few texels does not.
TEST(MaskLevels, WhatHoldsThePatternStaysAsItWas) {
  struct Case {
    const char* name;
    Image<glm::vec4> texels;
    int least, most;  // that its coarsest resolved level may be
  };
  for (const Case& one :
       {Case{"leaf of 256", samples::leafMask(256), 5, 5}, Case{"leaf of 128", samples::leafMask(128), 4, 4},
        Case{"slats of 512", samples::slatMask(512), 4, 5}, Case{"discs of 20%", discs(4.0), 0, 2},
        Case{"discs of 60%", discs(7.0), 0, 1}, Case{"noise of 50%", noise(0.5f), 0, 0},
        Case{"noise of 20%", noise(0.2f), 0, 0}}) {
    const std::vector<Image<glm::vec4>> cut = coveragePreservingMips(one.texels, 0.5f);
    const MaskLevels mask = maskLevels(cut, 0.5f, Sampling{});
    printf("[ figure ] %s: cut up to level %d\n", one.name, mask.resolved);
    EXPECT_GE(mask.resolved, one.least) << one.name;
    EXPECT_LE(mask.resolved, one.most) << one.name;
    ASSERT_EQ(mask.levels.size(), cut.size());
    const double wanted = meanAlpha(keptTexels(one.texels, 0.5f, Sampling{}));
    for (std::size_t i = 0; i < cut.size(); ++i) {
      if (static_cast<int>(i) <= mask.resolved) {
        EXPECT_EQ(std::memcmp(cut[i].data(), mask.levels[i].data(), cut[i].size() * sizeof(glm::vec4)), 0);
      } else {
        EXPECT_NEAR(meanAlpha(mask.levels[i]), wanted, 1e-5) << one.name << ", level " << i;
      }
    }
  }
}

// Against the closed form of a lone texel: 4 times the part of a quarter where (1 - u)(1 - v) reaches the cutoff.
TEST(MaskLevels, WhatACutLeavesOfALoneTexelIsItsClosedForm) {
  const Image<glm::vec4> lone = drawn(8, 8, [](int x, int y) { return x == 3 && y == 4 ? 1.0f : 0.0f; });
  const Image<glm::vec4> half = keptTexels(lone, 0.5f, Sampling{});
  // Four lines across a quarter: the midpoint rule of a smooth function, off by less than a 32nd of it.
  EXPECT_NEAR(half.at(3, 4).a, 4.0 * (0.5 - 0.5 * std::log(2.0)), 0.01);
  EXPECT_NEAR(meanAlpha(half) * 64.0, 4.0 * (0.5 - 0.5 * std::log(2.0)), 0.01);
  const double cut = 0.2, wanted = 4.0 * (1.0 - cut + cut * std::log(cut));
  EXPECT_NEAR(meanAlpha(keptTexels(lone, 0.2f, Sampling{})) * 64.0, wanted, 0.02);
  Sampling nearest;
  nearest.nearest = true;
  EXPECT_EQ(meanAlpha(keptTexels(lone, 0.2f, nearest)) * 64.0, 1.0);
}

// Nothing but the covered texels' colour, also where the cut leaves a part of a clear one; sizes that do not halve.
TEST(MaskLevels, ClearTexelsLendNoColour) {
  for (const glm::ivec2 size : {glm::ivec2(16, 16), {7, 3}, {1, 9}, {33, 17}}) {
    Image<glm::vec4> texels(size.x, size.y);
    for (int i = 0; i < size.x * size.y; ++i)
      texels[static_cast<std::size_t>(i)] = i % 3 == 0 ? glm::vec4(0, 1, 0, 1) : glm::vec4(50, 0, 50, 0);
    const MaskLevels mask = maskLevels(averagedLevels(texels), 0.2f, Sampling{});
    EXPECT_EQ(mask.levels.back().size(), 1u);
    for (std::size_t i = 1; i < mask.levels.size(); ++i)
      for (std::size_t k = 0; k < mask.levels[i].size(); ++k) {
        const glm::vec4& texel = mask.levels[i][k];
        if (texel.a > 0.0f) {
          EXPECT_NEAR(texel.r, 0.0f, 1e-5f);
          EXPECT_NEAR(texel.g, 1.0f, 1e-5f);
        }
      }
  }
}

// Stripes far finer than the pixels are half covered everywhere: as a rim is, they take their occlusion from around.
TEST(OcclusionPass, WhatIsPartlyCoveredFarAwayInfersIt) {
  const Window window{0, 0, 64, 48};
  Camera camera;
  camera.focal = {2.0 * 48 / 64, 2.0};
  LeafStage stage(window, window, camera);
  // 1 m at 2 m: 24 pixels, 10.7 texels each.
  stage.addCards({{{-0.5, -0.5, -2.0}, {1, 0, 0}, {0, 1, 0}}},
                 stage.addMask(drawn(256, 256, [](int x, int) { return x % 4 < 2 ? 1.0f : 0.0f; })));
  for (std::size_t i = 0; i < stage.gbuffer.viewZ.size(); ++i) stage.gbuffer.viewZ[i] = 2.01f;
  for (const int passes : {1, 8}) {
    PassSettings settings;
    settings.surroundings = glm::vec3(1.0f);
    settings.footprint = 1.0f / std::sqrt(static_cast<float>(passes));
    const Veil open = stage.veil(settings);
    settings.occlusion.occluders =
        std::make_shared<OccluderPlanes>(OccluderPlanes{window, stage.gbuffer.viewZ, Image<float>(64, 48, 0.25f)});
    const Veil occluded = stage.veil(settings);
    int seen = 0;
    for (int y = 16; y < 32; ++y)
      for (int x = 24; x < 40; ++x) {
        ASSERT_TRUE(open.touched.at(x, y));
        EXPECT_NEAR(open.transmission.at(x, y).g, 0.5f, 0.02f) << x << ' ' << y;
        EXPECT_NEAR(occluded.light.at(x, y).g / open.light.at(x, y).g, 0.25f, 1e-3f) << x << ' ' << y;
        ++seen;
      }
    EXPECT_EQ(seen, 256);
  }
}

}  // namespace
}  // namespace pellucid
