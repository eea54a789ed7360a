// The CPU steps: fold, sorted over, veil, compose, error, antialiasing pattern.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "composite/antialias.h"
#include "composite/error.h"
#include "composite/fold.h"
#include "composite/over.h"
#include "composite/resolve.h"
#include "tests/support/layers.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using namespace test;
using reference::Layer;
using reference::Rgb;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

FragmentLists onePixel(const std::vector<Fragment>& fragments, glm::vec4 solid = glm::vec4(0, 0, 0, kInfinity)) {
  FragmentLists lists;
  lists.window = {0, 0, 1, 1};
  lists.offsets = {0, fragments.size()};
  lists.fragments = fragments;
  lists.solid = Image<glm::vec4>(1, 1, solid);
  return lists;
}

GBuffer oneBackground(glm::vec4 colour) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 1, 1};
  gbuffer.beauty = Image<glm::vec4>(1, 1, colour);
  gbuffer.viewZ = Image<float>(1, 1, kInfinity);
  return gbuffer;
}

glm::vec4 overOne(const std::vector<Fragment>& fragments, glm::vec4 background,
                  glm::vec4 solid = glm::vec4(0, 0, 0, kInfinity)) {
  Veil veil(1, 1);
  compositeSorted(onePixel(fragments, solid), {0, 0, 1, 1}, veil);
  return compose(veil, oneBackground(background)).rgba.at(0, 0);
}

std::vector<Layer> randomStack(Random& random, int count) {
  std::vector<Layer> layers(static_cast<std::size_t>(count));
  for (Layer& layer : layers) {
    layer.coverage = random.uniform();
    for (std::size_t c = 0; c < 3; ++c) {
      layer.transmission[c] = random.uniform();
      layer.reflected[c] = random.uniform() * 2;
      layer.additive[c] = random.below(4) ? 0 : random.uniform();
    }
    layer.z = random.between(1, 50);
    layer = rounded(layer);
  }
  return layers;
}

TEST(Over, EqualsTheReferenceInAnyOrder) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    std::vector<Layer> layers = randomStack(random, 1 + static_cast<int>(random.below(40)));
    const Rgb truth = reference::sortedOver(layers, {.3, .6, .9});
    std::vector<Fragment> fragments;
    for (const Layer& layer : layers) fragments.push_back(fragmentOf(layer));
    const glm::vec4 first = overOne(fragments, glm::vec4(.3f, .6f, .9f, 1));
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(first[c]) - truth[static_cast<std::size_t>(c)]) /
                                  std::max(1.0, truth[static_cast<std::size_t>(c)]));
    for (std::size_t i = fragments.size(); i > 1; --i)
      std::swap(fragments[i - 1], fragments[random.below(static_cast<std::uint32_t>(i))]);
    EXPECT_EQ(first, overOne(fragments, glm::vec4(.3f, .6f, .9f, 1))) << "seed " << seed;
  }
  printf("[ figure ] over against the reference: worst error %.2g x max(1, value)\n", worst);
  EXPECT_LT(worst, 4e-7);  // radiance and the results are rounded to float; everything between is double
}

TEST(Over, CoincidentLayersMergeSymmetrically) {
  Layer red, green;
  red.coverage = green.coverage = .5;
  red.reflected = {1, 0, 0};
  green.reflected = {0, 1, 0};
  red.z = green.z = 3;
  const glm::vec4 ab = overOne({fragmentOf(red), fragmentOf(green)}, glm::vec4(0, 0, 1, 1));
  EXPECT_EQ(ab, overOne({fragmentOf(green), fragmentOf(red)}, glm::vec4(0, 0, 1, 1)));
  EXPECT_NEAR(ab.r, .375, 1e-6);  // half of 1 - .5 * .5 each
  EXPECT_NEAR(ab.g, .375, 1e-6);
  EXPECT_NEAR(ab.b, .25, 1e-6);
}

TEST(Over, NothingBehindASolidShows) {
  Layer behind, front;
  behind.coverage = front.coverage = .5;
  behind.reflected = {9, 9, 9};
  front.reflected = {.2, .4, .6};
  behind.z = 8;
  front.z = 2;
  const glm::vec4 solid(.5f, .5f, .5f, 4.0f);
  const glm::vec4 result = overOne({fragmentOf(behind), fragmentOf(front)}, glm::vec4(7, 7, 7, .25f), solid);
  EXPECT_NEAR(result.r, .35, 1e-6);
  EXPECT_NEAR(result.g, .45, 1e-6);
  EXPECT_EQ(result.a, 1.0f);
  // The same through the sums.
  OitPlanes planes = emptyPlanes({0, 0, 1, 1}, {0, 0, 1, 1});
  foldFragments(onePixel({fragmentOf(behind), fragmentOf(front)}, solid), weightOf(shading::PLD_WEIGHT_EQ5),
                shading::PLD_NORMALISE_SPECTRAL, planes);
  const glm::vec4 blended = compose(resolve(planes, {}), oneBackground(glm::vec4(7, 7, 7, .25f))).rgba.at(0, 0);
  EXPECT_NEAR(blended.r, .35, 1e-6);
  EXPECT_EQ(blended.a, 1.0f);
}

TEST(Over, AlphaOfTheResult) {
  Layer pane;
  pane.coverage = .5;
  pane.z = 2;
  EXPECT_NEAR(overOne({fragmentOf(pane)}, glm::vec4(0, 0, 0, 0)).a, .5, 1e-6);
  EXPECT_NEAR(overOne({fragmentOf(pane)}, glm::vec4(0, 0, 0, .5f)).a, .75, 1e-6);
}

TEST(Compose, UntouchedPixelsAreTheBackgroundAndNonFiniteColourStaysHome) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, 3, 1};
  gbuffer.beauty = Image<glm::vec4>(3, 1, glm::vec4(1, 2, 3, 1));
  gbuffer.beauty.at(1, 0).g = std::numeric_limits<float>::quiet_NaN();
  gbuffer.beauty.at(2, 0).g = std::numeric_limits<float>::quiet_NaN();
  Veil veil(3, 1);
  veil.touched.at(1, 0) = veil.touched.at(2, 0) = 1;
  veil.light.at(1, 0) = veil.light.at(2, 0) = glm::vec3(.5f);
  veil.transmission.at(1, 0) = glm::vec3(.5f);
  veil.transmission.at(2, 0) = glm::vec3(0.0f);
  const Picture picture = compose(veil, gbuffer);
  EXPECT_EQ(picture.rgba.at(0, 0), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(picture.rgba.at(1, 0).r, 1.0f);
  EXPECT_TRUE(std::isnan(picture.rgba.at(1, 0).g));
  EXPECT_EQ(picture.rgba.at(2, 0).g, .5f);  // hidden behind a solid
}

TEST(Compose, TransparentPlusTransmissionTimesBackgroundIsThePicture) {
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    OitPlanes planes = emptyPlanes({0, 0, 1, 1}, {0, 0, 1, 1});
    std::vector<Fragment> fragments;
    for (const Layer& layer : randomStack(random, 1 + static_cast<int>(random.below(6))))
      fragments.push_back(fragmentOf(layer));
    foldFragments(onePixel(fragments), weightOf(shading::PLD_WEIGHT_EQ5), shading::PLD_NORMALISE_SPECTRAL, planes);
    const Veil veil = resolve(planes, {});
    const glm::vec4 background(random.uniformf(), random.uniformf(), random.uniformf(), 1);
    const glm::vec4 picture = compose(veil, oneBackground(background)).rgba.at(0, 0);
    for (int c = 0; c < 3; ++c) {
      const float expected = veil.light.at(0, 0)[c] + veil.transmission.at(0, 0)[c] * background[c];
      EXPECT_LE(std::abs(picture[c] - expected), std::nextafter(expected, kInfinity) - expected);
    }
  }
}

TEST(Fold, AnyOrderAgreesToRounding) {
  Random random(5);
  std::vector<Fragment> fragments;
  for (const Layer& layer : randomStack(random, 60)) fragments.push_back(fragmentOf(layer));
  OitPlanes forward = emptyPlanes({0, 0, 1, 1}, {0, 0, 1, 1}), backward = forward;
  foldFragments(onePixel(fragments), weightOf(shading::PLD_WEIGHT_EQ7Z), 0, forward);
  std::reverse(fragments.begin(), fragments.end());
  foldFragments(onePixel(fragments), weightOf(shading::PLD_WEIGHT_EQ7Z), 0, backward);
  const glm::vec4 a = compose(resolve(forward, {}), oneBackground(glm::vec4(1))).rgba.at(0, 0);
  const glm::vec4 b = compose(resolve(backward, {}), oneBackground(glm::vec4(1))).rgba.at(0, 0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 60 * 1.2e-7f * std::max(1.0f, a[c]));  // n ulp
  EXPECT_EQ(forward.frontZ.at(0, 0), backward.frontZ.at(0, 0));
}

TEST(Veil, MeanOfSamples) {
  Veil a(1, 1), b(1, 1);
  a.touched.at(0, 0) = 1;
  a.light.at(0, 0) = glm::vec3(1.0f);
  a.transmission.at(0, 0) = glm::vec3(0.5f);
  a.frontZ.at(0, 0) = 3;
  VeilMean mean;
  mean.add(a);
  mean.add(b);
  const Veil veil = mean.finish();
  EXPECT_EQ(veil.light.at(0, 0), glm::vec3(0.5f));
  EXPECT_EQ(veil.transmission.at(0, 0), glm::vec3(0.75f));
  EXPECT_EQ(veil.frontZ.at(0, 0), 3);
  EXPECT_EQ(veil.touched.at(0, 0), 1);
}

TEST(Veil, RowsAddUpToTheBitsOfWholeSamples) {
  Random random(71);
  VeilMean whole, rows;
  for (int pass = 0; pass < 4; ++pass) {
    Veil veil(5, 7);
    veil.place = {3, 2};
    if (pass % 2 == 1) veil.addScatter();
    for (std::size_t i = 0; i < veil.touched.size(); ++i) {
      veil.touched[i] = static_cast<std::uint8_t>(random.below(2));
      veil.light[i] = glm::vec3(random.uniformf(), -0.0f, random.uniformf());
      veil.transmission[i] = glm::vec3(random.uniformf());
      veil.frontZ[i] = 1.0f + random.uniformf();
      if (!veil.scatters()) continue;
      veil.direct[i] = glm::vec3(random.uniformf());
      veil.applied[i] = glm::vec4(random.uniformf());
    }
    whole.add(veil);
    rows.begin(veil);
    for (int y = 0; y < 7; y += 3) rows.addRows(rowsOf(veil, y, std::min(y + 3, 7)));
  }
  const Veil expected = whole.finish(), found = rows.finish();
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_EQ(found.place, expected.place);
  EXPECT_TRUE(same(found.light, expected.light));
  EXPECT_TRUE(same(found.transmission, expected.transmission));
  EXPECT_TRUE(same(found.frontZ, expected.frontZ));
  EXPECT_TRUE(same(found.touched, expected.touched));
  EXPECT_TRUE(same(found.direct, expected.direct));
  EXPECT_TRUE(same(found.applied, expected.applied));
}

TEST(Error, Statistics) {
  Image<glm::vec4> truth(10, 10, glm::vec4(.5f)), picture = truth;
  picture.at(3, 7).g = 1.0f;
  picture.at(1, 1).r = std::numeric_limits<float>::quiet_NaN();
  const ErrorStatistics error = measureError(picture, truth);
  EXPECT_EQ(error.nonFinite, 1u);
  EXPECT_EQ(error.pixels, 99u);
  EXPECT_NEAR(error.mean, .5 / 297, 1e-12);
  EXPECT_NEAR(error.rmse, std::sqrt(.25 / 297), 1e-12);
  EXPECT_EQ(error.maximum, .5);
  EXPECT_EQ(error.worstX, 3);
  EXPECT_EQ(error.worstY, 7);
}

// Area of the unit square on one side of a line, by clipping.
double coveredArea(double nx, double ny, double offset) {
  const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  double twice = 0, first[2] = {}, last[2] = {};
  bool any = false;
  const auto add = [&](double x, double y) {
    if (any)
      twice += last[0] * y - x * last[1];
    else
      first[0] = x, first[1] = y, any = true;
    last[0] = x, last[1] = y;
  };
  for (int i = 0; i < 4; ++i) {
    const double* a = corners[i];
    const double* b = corners[(i + 1) % 4];
    const double da = nx * a[0] + ny * a[1] - offset, db = nx * b[0] + ny * b[1] - offset;
    if (da <= 0) add(a[0], a[1]);
    if ((da <= 0) != (db <= 0)) add(a[0] + (b[0] - a[0]) * da / (da - db), a[1] + (b[1] - a[1]) * da / (da - db));
  }
  if (!any) return 0;
  add(first[0], first[1]);
  return std::abs(twice) / 2;
}

TEST(Antialias, EdgesOfEverySlope) {
  for (const int count : {1, 4, 8, 16, 32}) {
    double worst = 0, sum = 0;
    int edges = 0;
    for (int angle = 0; angle < 180; ++angle)
      for (int step = 0; step < 200; ++step) {
        const double theta = (angle + 0.5) * 3.14159265358979 / 180, nx = std::cos(theta), ny = std::sin(theta);
        const double low = std::min({0.0, nx, ny, nx + ny}), high = std::max({0.0, nx, ny, nx + ny});
        const double offset = low + (high - low) * (step + .5) / 200;
        int inside = 0;
        for (int i = 0; i < count; ++i) {
          const glm::dvec2 p = samplePosition(i, count);
          inside += nx * p.x + ny * p.y <= offset;
        }
        const double error = std::abs(static_cast<double>(inside) / count - coveredArea(nx, ny, offset));
        worst = std::max(worst, error);
        sum += error;
        ++edges;
      }
    printf("[ figure ] %2d samples: error of an edge's coverage, mean %.4f, worst %.4f (x N: %.2f)\n", count,
           sum / edges, worst, worst * count);
    if (count == 16) {
      EXPECT_LT(sum / edges, 0.5 / 16);
      EXPECT_LT(worst, 1.7 / 16);
    }
  }
}

TEST(Antialias, PatternsAreCentredOnThePixel) {
  for (const int count : {1, 2, 4, 8, 16, 64}) {
    glm::dvec2 mean(0);
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 p = samplePosition(i, count);
      EXPECT_TRUE(p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1);
      mean += p / static_cast<double>(count);
    }
    EXPECT_NEAR(mean.x, .5, 1e-4) << count;
    EXPECT_NEAR(mean.y, .5, 1e-4) << count;
  }
}

}  // namespace
}  // namespace pellucid
