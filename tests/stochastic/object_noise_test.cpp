// Noise that stays with its object: pieces of triangles instead of pixels in the random numbers of stochastic masks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>

#include "engine_bridge/embree/ray_fragments.h"
#include "shaders/piece.h"
#include "tests/stochastic/examples.h"
#include "tests/stochastic/sampled_stage.h"

namespace pellucid {
namespace {

using namespace test;

PassSettings piecewise() {
  PassSettings settings;
  settings.pieces = true;
  return settings;
}

TEST(Pieces, AreAboutAPixelLargeAndHalveOneByOne) {
  constexpr int kPixels = 4000, kPlaces = 4 * kPixels;  // pieces are half a pixel wide at least
  constexpr float kStep = 1.01f;
  std::set<std::uint32_t> before;
  for (float perPixel = 1.0f / 5000; perPixel < 1.0f / 1200; perPixel *= kStep) {
    std::set<std::uint32_t> names;
    int runs = 0;
    std::uint32_t last = 0;
    for (int i = 0; i < kPlaces; ++i) {
      const float at = perPixel * (static_cast<float>(i) + .5f) * .25f;
      const std::uint32_t name = shading::pieceOf(77u, {at, .25f}, {perPixel, 0.0f});
      runs += i == 0 || name != last ? 1 : 0;
      names.insert(last = name);
    }
    EXPECT_EQ(runs, static_cast<int>(names.size())) << "a piece is in one place";
    EXPECT_GE(runs, kPixels / 2) << perPixel;
    EXPECT_LE(runs, 2 * kPixels) << perPixel;
    // From a hundredth farther away, two in a hundred have become one with their neighbour at most.
    double kept = 0;
    for (const std::uint32_t name : before) kept += names.count(name) ? 1 : 0;
    EXPECT_GE(kept, .95 * static_cast<double>(before.size())) << perPixel;
    before = std::move(names);
  }
}

TEST(Pieces, OfNumbersThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float at : {nan, infinity, -infinity, 3e38f, -3e38f, -.3f})
    for (const float perPixel : {nan, infinity, 0.0f, 1e-30f, 3e38f, .01f})
      EXPECT_EQ(shading::pieceOf(5u, {at, at}, {perPixel, perPixel}),
                shading::pieceOf(5u, {at, at}, {perPixel, perPixel}));
  EXPECT_EQ(shading::pieceOf(5u, {.1f, .2f}, {2.0f, 3.0f}), shading::pieceOf(5u, {.8f, .1f}, {2.0f, 3.0f}))
      << "a triangle smaller than a pixel is one piece";
}

// As in gl_test.cpp, where a pixel's random numbers are its own; a piece is at most two pixels wide and high, so four
// share theirs at most.
TEST(ObjectNoise, ExamplesMatchEnumeration) {
  constexpr int kEdge = 200;
  constexpr double kPixels = kEdge * kEdge, kDraws = kPixels / 4;
  for (const Row& row : kRows) {
    const auto layers = exampleLayers(row.example);
    const reference::Rgb behind = behindExample(row.example);
    const StochasticSettings settings = settingsOf(row.estimator, row.stratified);
    Stage stage(kEdge, kEdge);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const glm::vec3 colour(layers[i].colour[0], layers[i].colour[1], layers[i].colour[2]);
      stage.quad(-3, -5, kEdge + 7, kEdge + 11, 1.0 + static_cast<double>(i),
                 stage.add(unlitBlend(colour, static_cast<float>(layers[i].alpha))));
    }
    const StochasticPlanes planes = sampleStage(stage, passOf(settings), piecewise());
    const Moments exact = reference::enumerate(layers, behind, kSamples, row.stratified, row.estimator);
    glm::dvec3 mean(0), second(0), fourth(0);
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const glm::dvec3 off = pictureOf(sumsAt(planes, x, y), {behind[0], behind[1], behind[2]}, settings) -
                               glm::dvec3(exact.mean[0], exact.mean[1], exact.mean[2]);
        mean += off / kPixels;
        second += off * off / kPixels;
        fourth += off * off * off * off / kPixels;
      }
    std::printf("%-20s off by (%.4f, %.4f, %.4f), deviation (%.3f, %.3f, %.3f)\n", row.label, mean.r, mean.g, mean.b,
                std::sqrt(second.r), std::sqrt(second.g), std::sqrt(second.b));
    for (std::size_t c = 0; c < 3; ++c) {
      const double variance = exact.deviation[c] * exact.deviation[c];
      const auto i = static_cast<int>(c);
      EXPECT_NEAR(mean[i], 0.0, 3 * exact.deviation[c] / std::sqrt(kDraws) + 2e-5) << row.label << c;
      EXPECT_NEAR(second[i], variance, 3 * std::sqrt(std::max(0.0, fourth[i] - variance * variance) / kDraws) + 2e-5)
          << row.label << c;
    }
  }
}

// Three panes at one distance from the eye and another; all that is seen moves by so many pixels.
Stage panesMovedBy(double right, double down) {
  Stage stage(96, 80);
  stage.camera.orthographic = true;
  const glm::vec3 colours[] = {{1, .1f, .1f}, {.1f, 1, .1f}, {.2f, .2f, 1}};
  for (int i = 0; i < 3; ++i) {
    const double z = 1.0 + i, x = 7.3 + 4.1 * i + right, y = 5.7 + 3.3 * i + down;
    stage.slanted(x, y, x + 60.9, y + 52.3, z, z + .5, stage.add(unlitBlend(colours[i], .4f)));
  }
  return stage;
}

struct Followed {
  double same = 0;               // part of the pixels in which both pictures have the same samples
  double change = 0, noise = 0;  // mean squares: of the light's change, of the light about its mean
};

// What a picture's noise does from one frame to the next, seen from a place that moves along by whole pixels.
Followed follow(const PassSettings& settings, double right, double down, glm::ivec2 along) {
  StochasticSettings samples;
  samples.samples = 8;
  const StochasticPlanes one = sampleStage(panesMovedBy(0, 0), passOf(samples), settings),
                         two = sampleStage(panesMovedBy(right, down), passOf(samples), settings);
  Followed found;
  double mean = 0;
  int count = 0;
  const auto each = [&](const auto& see) {
    for (int y = 20; y < 50; ++y)  // where all three lie over one another in both pictures
      for (int x = 24; x < 60; ++x) see(glm::ivec2(x, y));
  };
  each([&](glm::ivec2 at) {
    mean += static_cast<double>(one.empty.at(at.x, at.y).r);
    ++count;
  });
  mean /= count;
  each([&](glm::ivec2 at) {
    const glm::ivec2 then = at + along;
    const double before = static_cast<double>(one.empty.at(at.x, at.y).r),
                 after = static_cast<double>(two.empty.at(then.x, then.y).r);
    found.same += (one.light.at(at.x, at.y) == two.light.at(then.x, then.y) && before == after ? 1.0 : 0.0) / count;
    found.change += (before - after) * (before - after) / count;
    found.noise += (before - mean) * (before - mean) / count;
  });
  return found;
}

TEST(ObjectNoise, MovesWithWhatMoves) {
  const auto say = [](const char* what, const Followed& found) {
    std::printf("%-50s %5.1f %% of the pixels alike, change %.3f of independent noise\n", what, 100 * found.same,
                found.change / (2 * found.noise));
  };
  const Followed screen = follow({}, 5, 3, {5, 3}), object = follow(piecewise(), 5, 3, {5, 3});
  say("whole pixels, noise on the screen", screen);
  say("whole pixels, noise on the object", object);
  EXPECT_LT(screen.same, .2);
  EXPECT_GT(screen.change / (2 * screen.noise), .85);
  EXPECT_GT(object.same, .99) << "but where a pixel's middle lies within rounding of a piece's edge";
  EXPECT_LT(object.change / (2 * object.noise), .01);
  const Followed between = follow(piecewise(), 5.37, 3.21, {5, 3}), stays = follow({}, 5.37, 3.21, {0, 0});
  say("5.37 and 3.21 pixels, noise on the object", between);
  say("the same, noise on the screen, a pixel that stays", stays);
  EXPECT_LT(between.change / (2 * between.noise), .9);
}

TEST(ObjectNoise, TheCpuSamplesTheSamePieces) {
  Stage stage = mixture();
  const std::vector<FragmentLists> tiles = stage.fragments(piecewise());
  for (const Variant variant : {Variant::basic, Variant::depth}) {
    StochasticSettings settings;
    settings.variant = variant;
    settings.samples = 24;
    settings.onObjects = true;
    const StochasticPlanes planes = sampleStage(stage, passOf(settings), piecewise());
    const MaskTable masks(settings.samples);
    double worst = 0;
    for (const FragmentLists& lists : tiles)
      for (int y = 0; y < lists.window.height(); ++y)
        for (int x = 0; x < lists.window.width(); ++x) {
          std::vector<MethodLayer> layers;
          const int u = lists.window.x0 + x, v = lists.window.y0 + y;
          layersOf(lists, static_cast<std::size_t>(y * lists.window.width() + x), lists.solid.at(x, y).a, layers);
          const StochasticSums cpu = samplePixel(layers, {u, v}, settings, masks, {});
          const StochasticSums gl = sumsAt(planes, u, v);
          EXPECT_EQ(glm::vec3(cpu.empty), glm::vec3(gl.empty)) << u << "," << v;
          for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(cpu.light[c] - gl.light[c]) / std::max(1.0, cpu.light[c]));
        }
    EXPECT_LT(worst, 3e-5);
  }
}

TEST(ObjectNoise, RaysNameTheSamePieces) {
  // In perspective, and where no edge of a piece passes a row of pixels' middles.
  Stage stage(96, 80);
  for (int i = 0; i < 3; ++i)
    stage.slanted(7.3 + 4.1 * i, 5.7 + 3.3 * i, 68.2 + 5.3 * i, 58.1 + 2.9 * i, 1 + i, 2.7 + i,
                  stage.add(unlitBlend({1, .5f, .2f}, .4f)));
  PassSettings settings = piecewise();
  settings.filter = TextureFilter::bilinear;
  settings.sample = {.3, .8};
  const auto names = [](const FragmentLists& lists, std::vector<std::multiset<std::uint32_t>>& pixels) {
    for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i) {
      pixels.emplace_back();
      for (std::uint64_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k)
        pixels.back().insert(lists.fragments[k].identity);
    }
  };
  settings.tile = 96;  // rows as wide as the picture
  std::vector<std::multiset<std::uint32_t>> drawn, traced;
  for (const FragmentLists& lists : stage.fragments(settings)) names(lists, drawn);
  RayFragments(stage.scene, stage.gbuffer, stage.camera).fragments(settings, [&](const FragmentLists& lists) {
    names(lists, traced);
  });
  ASSERT_EQ(drawn.size(), traced.size());
  std::size_t alike = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) alike += drawn[i] == traced[i] ? 1 : 0;
  std::printf("rays and GL name the same pieces in %zu of %zu pixels\n", alike, drawn.size());
  EXPECT_GT(static_cast<double>(alike), .99 * static_cast<double>(drawn.size())) << "edges of pieces, within rounding";
}

// One sample position after another: a pixel's masks stay stratified across its passes.
TEST(ObjectNoise, AllPassesOfAPixelMeanOnePiece) {
  Stage stage = panesMovedBy(0, 0);
  std::vector<std::uint32_t> first;
  std::size_t alike = 0, all = 0;
  for (const glm::dvec2 sample : {glm::dvec2(.5, .5), glm::dvec2(.06, .9), glm::dvec2(.97, .02)}) {
    PassSettings settings = piecewise();
    settings.sample = sample;
    settings.tile = 96;
    std::vector<std::uint32_t> found;
    for (const FragmentLists& lists : stage.fragments(settings))
      for (int y = lists.window.y0; y < lists.window.y1; ++y)
        for (int x = lists.window.x0; x < lists.window.x1; ++x) {
          const auto i = static_cast<std::size_t>((y - lists.window.y0) * lists.window.width() + x - lists.window.x0);
          std::uint32_t names = 0;  // of all layers, in any order
          for (std::uint64_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) names += lists.fragments[k].identity;
          if (x >= 20 && x < 60 && y >= 14 && y < 54) found.push_back(names);
        }
    if (first.empty()) first = found;
    ASSERT_EQ(found.size(), 1600u);
    for (std::size_t i = 0; i < found.size(); ++i) alike += found[i] == first[i] ? 1 : 0;
    all += found.size();
  }
  // A triangle's diagonal passes between a pixel's samples.
  EXPECT_GT(static_cast<double>(alike), .9 * static_cast<double>(all));
}

}  // namespace
}  // namespace pellucid
