// Refracted lookups, and what resolve makes of them.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/fold.h"
#include "composite/over.h"
#include "composite/resolve.h"
#include "tests/scatter/backdrop.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using test::ScatterScene;
constexpr float kNothing = std::numeric_limits<float>::infinity();

// Colour is position, so that a lookup says where it was made.
ScatterScene atlas(int width, int height) {
  ScatterScene scene(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      scene.backdrop.colour.at(x, y) = glm::vec4(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 1);
  return scene;
}

TEST(Lookup, LandsWhereTheOffsetPointsToAHundredthOfAPixel) {
  test::Random random(11);
  ScatterScene scene = atlas(128, 96);
  Image<glm::vec2> offsets(128, 96);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x) {
      const glm::vec2 target(1 + 126 * random.uniformf(), 1 + 94 * random.uniformf());
      offsets.at(x, y) = target - glm::vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      scene.refract(x, y, offsets.at(x, y));
    }
  const Image<glm::vec4> seen = scene.look(false);
  float worst = 0;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x) {
      const glm::vec2 target = offsets.at(x, y) + glm::vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float error = glm::length(glm::vec2(seen.at(x, y)) - target);
      if (!(error <= worst)) worst = error;  // NaN too
    }
  std::printf("refracted lookup: largest error %.2g px\n", static_cast<double>(worst));
  EXPECT_LE(worst, 0.01f);
}

TEST(Lookup, OutsideTheDataWindowReadsItsEdge) {
  ScatterScene scene = atlas(32, 32);
  for (int x = 0; x < 32; ++x) scene.refract(x, 5, glm::vec2(x < 16 ? -1e5f : 1e5f, 0.25f));
  scene.refract(3, 9, glm::vec2(-65536.0f, 65536.0f));
  const Image<glm::vec4> seen = scene.look(false);
  for (int x = 0; x < 32; ++x) EXPECT_FLOAT_EQ(seen.at(x, 5).r, x < 16 ? 0.5f : 31.5f);
  EXPECT_FLOAT_EQ(seen.at(3, 9).r, 0.5f);
  EXPECT_FLOAT_EQ(seen.at(3, 9).g, 31.5f);
}

TEST(Lookup, PostInFrontNeverShowsInsideTheGlassBehindIt) {
  ScatterScene scene(64, 32, glm::vec4(0.2f, 0.2f, 0.2f, 1), 20.0f);
  for (int y = 0; y < 32; ++y)
    for (int x = 28; x < 36; ++x) {
      scene.backdrop.colour.at(x, y) = glm::vec4(1, 0, 0, 1);
      scene.backdrop.z.at(x, y) = 2.0f;
    }
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      if (x < 28 || x >= 36) scene.refract(x, y, glm::vec2(x < 32 ? 9.3f : -9.3f, 0.4f), 5.0f);
  const Image<glm::vec4> seen = scene.look(false);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      if (x < 28 || x >= 36) {
        EXPECT_NEAR(seen.at(x, y).r, 0.2f, 1e-6f) << x << ' ' << y;
      }
}

// Glass on a leaning floor is met where a pass samples the pixel, farther than the pixel's centre; of what lies beside
// it a part shows that is as small as the offset.
TEST(Lookup, WhatIsStraightBehindGlassIsNeverInFrontOfIt) {
  ScatterScene scene(16, 16, glm::vec4(1, 1, 1, 1), 5.2f);
  for (int y = 0; y < 16; ++y) {
    scene.backdrop.colour.at(8, y) = glm::vec4(0.2f, 0.2f, 0.2f, 1);
    scene.backdrop.z.at(8, y) = 4.99f;
  }
  for (int y = 1; y < 15; ++y) scene.refract(8, y, glm::vec2(0.0625f, 0.0f));
  const Image<glm::vec4> seen = scene.look(false);
  for (int y = 1; y < 15; ++y) EXPECT_FLOAT_EQ(seen.at(8, y).r, 0.2f + 0.0625f * 0.8f);
}

TEST(Lookup, NoOffsetAndNoSpreadGiveThePixelsOwnBits) {
  test::Random random(12);
  ScatterScene scene(16, 16);
  for (std::size_t i = 0; i < scene.backdrop.colour.size(); ++i)
    scene.backdrop.colour[i] = glm::vec4(random.uniformf(), 1e6f * random.uniformf(), 1e-20f, 1);
  scene.backdrop.colour.at(7, 7).g = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) scene.refract(x, y, shading::recordedOffset(glm::vec2(0)));
  const Image<glm::vec4> seen = scene.look(false);
  EXPECT_TRUE(std::isnan(seen.at(7, 7).g));
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!std::isnan(seen[i].g)) {
      EXPECT_EQ(seen[i], scene.backdrop.colour[i]);
    }
}

Fragment layer(glm::vec3 radiance, float coverage, glm::vec3 transmission, float z) {
  Fragment fragment{};
  fragment.radiance = radiance;
  fragment.coverage = coverage;
  fragment.transmission = transmission;
  fragment.z = z;
  return fragment;
}

// One row of pixels, each with the same layers, over a step in brightness.
struct Row {
  static constexpr int kWidth = 32;
  GBuffer gbuffer;
  FragmentLists lists;

  explicit Row(const std::vector<Fragment>& layers) {
    const Window window{0, 0, kWidth, 1};
    gbuffer.display = gbuffer.data = window;
    gbuffer.beauty = Image<glm::vec4>(kWidth, 1, glm::vec4(0.2f, 0.2f, 0.2f, 1));
    for (int x = kWidth / 2; x < kWidth; ++x) gbuffer.beauty.at(x, 0) = glm::vec4(1);
    gbuffer.viewZ = Image<float>(kWidth, 1, 20.0f);
    lists.window = window;
    lists.solid = Image<glm::vec4>(kWidth, 1, glm::vec4(0, 0, 0, kNothing));
    lists.offsets.push_back(0);
    for (int x = 0; x < kWidth; ++x) {
      lists.fragments.insert(lists.fragments.end(), layers.begin(), layers.end());
      lists.offsets.push_back(lists.fragments.size());
    }
  }
  OitPlanes planes() const {
    OitPlanes planes = emptyPlanes(gbuffer.display, gbuffer.data);
    foldFragments(lists, planes.info.weight, planes.info.normalisation, planes);
    return planes;
  }
  Picture blended() const {
    OitPlanes sums = planes();
    const Image<glm::vec4> solid = sums.solid;
    hideSolids(sums);
    Veil veil = resolve(sums, {});
    return finish(veil, sums, solid);
  }
  Picture sorted() const {
    OitPlanes scatter = emptyPlanes(gbuffer.display, gbuffer.data);
    foldScattering(lists, scatter);
    const Image<glm::vec4> solid = scatter.solid;
    FragmentLists shown = lists;
    hideSolids(shown, scatter);
    Veil veil(kWidth, 1);
    compositeSorted(shown, gbuffer.data, veil);
    return finish(veil, scatter, solid);
  }
  Picture finish(Veil& veil, const OitPlanes& scatter, const Image<glm::vec4>& solid) const {
    if (scatter.scatters()) {
      const Backdrop backdrop = backdropOf(gbuffer, solid);
      showThrough(Lookups(backdrop, scatter, {}), veil);
    }
    return compose(veil, gbuffer);
  }
};

TEST(Lookup, ClearFrostedGlassDiffuses) {
  Fragment glass = layer(glm::vec3(0), 1, glm::vec3(1), 5);
  glass.variance = 16;
  for (const Picture& picture : {Row({glass}).blended(), Row({glass}).sorted()}) {
    EXPECT_GT(picture.rgba.at(15, 0).r, 0.4f);
    EXPECT_LT(picture.rgba.at(16, 0).r, 0.8f);
    EXPECT_NEAR(picture.rgba.at(0, 0).r, 0.2f, 0.01f);
    EXPECT_EQ(picture.rgba.at(15, 0).a, 1.0f);
  }
}

TEST(Lookup, ClearRefractingGlassRefracts) {
  Fragment glass = layer(glm::vec3(0), 1, glm::vec3(1), 5);
  glass.offset = glm::vec2(4, 0);
  for (const Picture& picture : {Row({glass}).blended(), Row({glass}).sorted()}) {
    EXPECT_FLOAT_EQ(picture.rgba.at(11, 0).r, 0.2f);
    EXPECT_FLOAT_EQ(picture.rgba.at(12, 0).r, 1.0f);
  }
}

TEST(Lookup, AdditiveLightWithoutCoverageShows) {
  const Fragment flame = layer(glm::vec3(0.5f, 0.25f, 0), 0, glm::vec3(1), 5);
  for (const Picture& picture : {Row({flame}).blended(), Row({flame}).sorted()}) {
    EXPECT_FLOAT_EQ(picture.rgba.at(3, 0).r, 0.7f);
    EXPECT_FLOAT_EQ(picture.rgba.at(3, 0).g, 0.45f);
  }
}

TEST(Lookup, SolidBehindGlassIsPartOfTheBackground) {
  Fragment glass = layer(glm::vec3(0.05f), 1, glm::vec3(0.5f), 5);
  glass.offset = glm::vec2(4, 0);
  Row row({glass, layer(glm::vec3(9), 0.5f, glm::vec3(0), 12)});  // the second lies behind the solid
  for (int x = 0; x < Row::kWidth; ++x) row.lists.solid.at(x, 0) = glm::vec4(0.1f * static_cast<float>(x), 0, 0, 8);
  for (const Picture& picture : {row.blended(), row.sorted()})
    for (int x = 0; x < 24; ++x) {
      EXPECT_NEAR(picture.rgba.at(x, 0).r, 0.05f + 0.5f * 0.1f * static_cast<float>(x + 4), 1e-6f) << x;
      EXPECT_EQ(picture.rgba.at(x, 0).a, 1.0f);
    }
}

TEST(Lookup, WithoutScatteringThePictureIsTransparentPlusTransmissionTimesBackground) {
  test::Random random(13);
  for (int i = 0; i < 200; ++i) {
    std::vector<Fragment> layers;
    for (std::uint32_t k = 0; k < 1 + random.below(6); ++k)
      layers.push_back(layer(glm::vec3(random.uniformf(), 9 * random.uniformf(), 0.1f), random.uniformf(),
                             glm::vec3(random.uniformf(), random.uniformf(), 1), 1 + 9 * random.uniformf()));
    const Row row(layers);
    const Veil veil = resolve(row.planes(), {});
    EXPECT_FALSE(veil.scatters());
    const Picture picture = compose(veil, row.gbuffer);
    for (int x = 0; x < Row::kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const float expected = veil.light.at(x, 0)[c] + veil.transmission.at(x, 0)[c] * row.gbuffer.beauty.at(x, 0)[c];
        const float found = picture.rgba.at(x, 0)[c];  // to 1 ulp
        EXPECT_TRUE(found >= std::nextafter(expected, 0.0f) && found <= std::nextafter(expected, 1e30f));
      }
  }
}

// A pane that takes part in every other sample: half its own background, half the one it shows.
TEST(Lookup, JitteredSamplesAverageTheBackgroundsTheyShow) {
  Fragment glass = layer(glm::vec3(0), 1, glm::vec3(1), 5);
  glass.offset = glm::vec2(4, 0);
  const Row with({glass}), without({layer(glm::vec3(0), 0.5f, glm::vec3(1), 5)});
  OitPlanes sums = with.planes();
  Veil bent = resolve(sums, {});
  const Backdrop backdrop = backdropOf(with.gbuffer, sums.solid);
  showThrough(Lookups(backdrop, sums, {}), bent);
  const Veil plain = resolve(without.planes(), {});
  for (const bool bentFirst : {true, false}) {
    VeilMean mean;
    mean.add(bentFirst ? bent : plain);
    mean.add(bentFirst ? plain : bent);
    const Picture picture = compose(mean.finish(), with.gbuffer);
    EXPECT_FLOAT_EQ(picture.rgba.at(14, 0).r, 0.6f);
    EXPECT_FLOAT_EQ(picture.rgba.at(5, 0).r, 0.2f);
    EXPECT_FLOAT_EQ(picture.rgba.at(14, 0).a, 1.0f);
  }
}

}  // namespace
}  // namespace pellucid
