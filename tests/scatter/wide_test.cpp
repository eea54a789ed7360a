// Gathers by lanes against the shared text as it stands, planes of a part against those of the picture, and sums of
// what scatters alone: the same bits.
#include <gtest/gtest.h>

#include <cstring>

#include "composite/denormals.h"
#include "composite/fold_exact.h"
#include "composite/lookup_text.h"
#include "tests/scatter/backdrop.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

using shading::GatherText;
using shading::LookupText;

bool same(const GatherText::Gathered& a, const GatherText::Gathered& b) {
  return std::memcmp(&a.colour, &b.colour, sizeof a.colour) == 0 && std::memcmp(&a.weight, &b.weight, 4) == 0;
}

// Spreads in patches with ramps and holes, posts in front of the glass, a colour that is not finite here and there.
ScatterScene patches(Random& random, int width, int height, float largest, bool gaps) {
  ScatterScene scene(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      scene.backdrop.colour.at(x, y) = glm::vec4(random.uniformf(), random.uniformf(), 9.0f * random.uniformf(), 1);
      float part = 1.0f - 0.001f * static_cast<float>(x);
      if (gaps && (x / 24 + y / 24) % 4 == 0) part = 0.0f;
      if (gaps && (x / 24 + y / 24) % 4 == 1) part *= random.uniformf();
      scene.diffuse(x, y, largest * part);
      if (gaps && x % 40 < 3) scene.backdrop.z.at(x, y) = 2.0f;
      if (gaps && random.uniformf() < 0.001f) scene.backdrop.colour.at(x, y).g = NAN;
    }
  return scene;
}

TEST(WideGather, HasTheBitsOfTheText) {
  Random random(41);
  const FlushDenormals flush;
  std::size_t wide = 0;
  for (const bool gaps : {false, true})
    for (const float largest : {0.4f, 0.9f, 2.0f, 3.9f, 4.0f, 7.0f, 12.0f, 33.0f}) {
      const ScatterScene scene = patches(random, 150, 97, largest, gaps);
      LookupText text(scene.backdrop, scene.planes, {}, glm::ivec2(0));
      for (int i = 0; i < 2500; ++i) {
        const int x = static_cast<int>(150.0 * random.uniform()), y = static_cast<int>(97.0 * random.uniform());
        const float variance = scene.planes.refraction.at(x, y).w;
        if (variance <= 0.0f) continue;
        glm::vec2 place(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        if (i % 2) place += glm::vec2(20.0f * random.uniformf() - 10.0f, 20.0f * random.uniformf() - 10.0f);
        const GatherText::Gathered lanes = text.gatherSpread(text.choice, place, variance, 5.0f);
        const GatherText::Gathered plain = text.GatherText::gatherSpread(text.choice, place, variance, 5.0f);
        ASSERT_TRUE(same(lanes, plain)) << largest << " px at " << place.x << ", " << place.y << (gaps ? ", gaps" : "");
        ++wide;
      }
    }
  EXPECT_GT(wide, 20000u);
}

TEST(WideGather, ExactGatherHasTheBitsOfTheText) {
  Random random(42);
  const FlushDenormals flush;
  LookupSettings exact;
  exact.exact = true;
  for (const float largest : {2.0f, 9.0f}) {
    const ScatterScene scene = patches(random, 120, 110, largest, true);
    LookupText text(scene.backdrop, scene.planes, exact, glm::ivec2(0));
    for (int y = 0; y < 110; y += 7)
      for (int x = 0; x < 120; ++x) {
        const float variance = scene.planes.refraction.at(x, y).w;
        const glm::vec2 place(static_cast<float>(x) + 0.3f, static_cast<float>(y) + 0.5f);
        ASSERT_TRUE(same(text.gatherSpread(text.choice, place, std::max(variance, 1.0f), 5.0f),
                         text.GatherText::gatherSpread(text.choice, place, std::max(variance, 1.0f), 5.0f)));
      }
  }
}

// Planes that end where nothing scatters any more look up what planes of the whole picture look up.
TEST(WideGather, PlanesOfAPartSeeThePicture) {
  Random random(43);
  for (const Window part : {Window{30, 20, 90, 70}, Window{0, 0, 50, 40}, Window{70, 50, 128, 96}}) {
    ScatterScene whole(128, 96);
    for (std::size_t i = 0; i < whole.backdrop.colour.size(); ++i)
      whole.backdrop.colour[i] = glm::vec4(random.uniformf(), random.uniformf(), random.uniformf(), 1);
    ScatterScene small(part.width(), part.height());
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1; ++x) {
        const float spread = (x / 16 + y / 16) % 3 == 0 ? 0.0f : 2.0f + 0.1f * static_cast<float>(x % 60);
        const glm::vec2 offset(30.0f * random.uniformf() - 15.0f, 30.0f * random.uniformf() - 15.0f);
        for (auto [scene, left, top] : {std::tuple(&whole, 0, 0), std::tuple(&small, part.x0, part.y0)}) {
          scene->diffuse(x - left, y - top, spread);
          scene->refract(x - left, y - top, offset);
        }
      }
    const Lookups wide(whole.backdrop, whole.planes, {}), narrow(whole.backdrop, small.planes, {}, {part.x0, part.y0});
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1; ++x) {
        const glm::vec4 a = wide.at(x, y), b = narrow.at(x - part.x0, y - part.y0);
        ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << x << ", " << y;
      }
  }
}

FragmentLists randomLists(Random& random, bool disperses) {
  FragmentLists lists;
  lists.window = {3, 2, 43, 26};
  lists.solid = Image<glm::vec4>(40, 24, glm::vec4(0, 0, 0, INFINITY));
  lists.offsets.assign(1, 0);
  for (std::size_t pixel = 0; pixel < lists.solid.size(); ++pixel) {
    if (random.uniform() < 0.2) lists.solid[pixel] = glm::vec4(1, 1, 1, 4.0f);
    for (int layers = static_cast<int>(6.0 * random.uniform()); layers > 0; --layers) {
      Fragment fragment{};
      fragment.coverage = random.uniformf();
      fragment.transmission = glm::vec3(random.uniformf());
      fragment.z = 1.0f + 6.0f * random.uniformf();
      if (random.uniform() < 0.7) fragment.offset = glm::vec2(9.0f * random.uniformf() - 4.0f, random.uniformf());
      if (random.uniform() < 0.5) fragment.variance = 1e4f * random.uniformf() * random.uniformf();
      lists.fragments.push_back(fragment);
      if (disperses) lists.dispersion.push_back(glm::vec4(random.uniformf(), 0, -random.uniformf(), 1));
    }
    lists.offsets.push_back(lists.fragments.size());
  }
  return lists;
}

TEST(FoldExact, WhatScattersAloneHasTheSameBits) {
  Random random(44);
  const Window window{0, 0, 48, 30};
  OitPlanes kept = emptyScatterPlanes(window, window);  // used again, as passes do
  for (int round = 0; round < 6; ++round) {
    const FragmentLists lists = randomLists(random, round >= 3);
    OitPlanes all = emptyPlanes(window, window);
    foldExact(lists, {shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f}, shading::PLD_NORMALISE_SPECTRAL, all);
    ASSERT_TRUE(foldExactScattering(lists, kept));
    EXPECT_EQ(kept.disperses(), round >= 3);
    for (int y = lists.window.y0; y < lists.window.y1; ++y)
      for (int x = lists.window.x0; x < lists.window.x1; ++x) {
        ASSERT_EQ(std::memcmp(&kept.refraction.at(x, y), &all.refraction.at(x, y), sizeof(glm::vec4)), 0);
        ASSERT_EQ(std::memcmp(&kept.refractionZ.at(x, y), &all.light.at(x, y).a, sizeof(float)), 0);
        ASSERT_EQ(kept.diffuseZ.at(x, y), all.diffuseZ.at(x, y));
        ASSERT_EQ(kept.solid.empty() ? glm::vec4(0, 0, 0, INFINITY) : kept.solid.at(x, y), all.solid.at(x, y));
        if (kept.disperses()) {
          ASSERT_EQ(kept.dispersion.at(x, y), all.dispersion.at(x, y));
        }
      }
  }
}

}  // namespace
}  // namespace pellucid::test
