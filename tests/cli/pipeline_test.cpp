// The verbs against each other: composite is the truth, composite by the sums = accumulate + resolve, order and chunks
// do not matter, edges are antialiased.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class Pipeline : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("pipeline-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
  }
  Ended run(const std::vector<std::string>& arguments) {
    Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended;
  }
  Image<glm::vec4> beauty(const std::string& name) { return readOpaque(folder + "/" + name, {}).gbuffer.beauty; }
  std::string folder;
  RunOptions options;
};

std::vector<Quad> crossingPanes() {
  return {Quad{{-1, -1, -4}, {2, 0, 1}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
          Quad{{-1, -1, -3}, {2, 0, -1}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)},
          Quad{{-.5f, -.2f, -2}, {.6f, 0, 0}, {0, .7f, 0}, unlit(.2f, .2f, 1, 1)}};
}

TEST_F(Pipeline, CompositeIsAccumulateThenResolve) {
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", crossingPanes());
  run({"composite", "opaque.exr", "glass.glb", "-o", "whole.exr", "--aa", "1", "--method", "phenomenological"});
  run({"accumulate", "opaque.exr", "glass.glb", "-o", "planes.exr"});
  run({"resolve", "opaque.exr", "planes.exr", "-o", "steps.exr"});
  const Image<glm::vec4> whole = beauty("whole.exr"), steps = beauty("steps.exr");
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_EQ(whole[i], steps[i]) << i;
}

TEST_F(Pipeline, OverDoesNotDependOnOrderOrBudget) {
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", crossingPanes());
  run({"composite", "opaque.exr", "glass.glb", "-o", "a.exr", "--aa", "1", "--method", "over"});
  run({"composite", "opaque.exr", "glass.glb", "-o", "b.exr", "--aa", "1", "--method", "over", "--order", "reverse"});
  run({"composite", "opaque.exr", "glass.glb", "-o", "c.exr", "--aa", "1", "--method", "over", "--order", "shuffle:7",
       "--budget", "64K", "--threads", "1"});
  const Image<glm::vec4> a = beauty("a.exr"), b = beauty("b.exr"), c = beauty("c.exr");
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i], b[i]) << i;
    ASSERT_EQ(a[i], c[i]) << i;
  }
}

TEST_F(Pipeline, OnePaneIsOverAtItsPixels) {
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .25f)}});
  run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--aa", "1"});
  const Image<glm::vec4> picture = beauty("out.exr");
  int covered = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const glm::vec4 pixel = picture.at(x, y);
      if (pixel == glm::vec4(.25f, .5f, .75f, 1)) continue;
      ++covered;
      EXPECT_NEAR(pixel.r, .25 + .75 * .25, 1e-6);
      EXPECT_NEAR(pixel.g, .375, 1e-6);
    }
  // 1 m at 3 m distance where the picture is 3 m: 64 / 3 = 21.33 pixels, centres at half: 22 x 22.
  EXPECT_EQ(covered, 22 * 22);
}

TEST_F(Pipeline, GlassBehindThePictureDoesNotShow) {
  writeOpaque(folder + "/opaque.exr", {.depth = 2.0f});
  writeGlb(folder + "/glass.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .25f)}});
  run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr"});
  const Image<glm::vec4> picture = beauty("out.exr"), before = beauty("opaque.exr");
  for (std::size_t i = 0; i < picture.size(); ++i) ASSERT_EQ(picture[i], before[i]);
}

// A pane whose left edge runs through (x0, top) and (x1, bottom) of the picture, to the right border and beyond.
TEST_F(Pipeline, CoverageOfASlantedEdge) {
  writeOpaque(folder + "/opaque.exr", {.colour = {0, 0, 0, 1}});
  // In-plane shear: the quad's up edge leans. At z = -3 the picture spans -1.5..1.5 m, 64 pixels.
  const double slope = 0.25;  // metres right per metre up
  Quad pane{{-.3f, -2, -3}, {9, 0, 0}, {static_cast<float>(4 * slope), 4, 0}, unlit(1, 1, 1, 1)};
  pane.material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1};
  writeGlb(folder + "/glass.glb", {pane});
  for (const auto& [samples, bound] : {std::pair{"1", 0.5}, std::pair{"4", 1.02 / 4}, std::pair{"16", 1.0 / 16}}) {
    run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--aa", samples});
    const Image<glm::vec4> picture = beauty("out.exr");
    double worst = 0, sum = 0;
    int edge = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        // Exact area right of the edge, by 4096 thin rows.
        double area = 0;
        for (int k = 0; k < 4096; ++k) {
          const double v = 1.5 - 3.0 * (y + (k + .5) / 4096) / 64;
          const double edgeX = (-.3 + (v + 2) * slope + 1.5) * 64 / 3;
          area += std::min(1.0, std::max(0.0, x + 1 - edgeX)) / 4096;
        }
        const double error = std::abs(static_cast<double>(picture.at(x, y).r) - area);
        worst = std::max(worst, error);
        if (area > 0 && area < 1) sum += error, ++edge;
      }
    printf("[ figure ] --aa %2s: coverage of a slanted edge, mean error %.4f, worst %.4f\n", samples, sum / edge,
           worst);
    EXPECT_LE(worst, bound + 1e-5) << samples;
  }
}

TEST_F(Pipeline, MeasureAndStatsAsJson) {
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", crossingPanes());
  const Ended ended = run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--aa", "2", "--method",
                           "phenomenological", "--measure", "--stats", "--json"});
  const auto report = nlohmann::json::parse(ended.out);
  EXPECT_GT(report["error"]["max"].get<double>(), 0.0);  // crossing panes: a weighted mean is not the truth
  EXPECT_LT(report["error"]["rmse"].get<double>(), 0.2);
  EXPECT_GT(report["statistics"]["fragments"].get<int>(), 0);
  const Ended truth =
      run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--aa", "2", "--measure", "--json"});
  EXPECT_EQ(nlohmann::json::parse(truth.out)["error"]["max"].get<double>(), 0.0);
}

TEST_F(Pipeline, LayersAddUpToThePicture) {
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", crossingPanes());
  run({"composite", "opaque.exr", "glass.glb", "-o", "out.exr", "--layers", "transparent,transmission,depth"});
  const Image<glm::vec4> picture = beauty("out.exr"), background = beauty("opaque.exr");
  ReadOptions transparent;
  transparent.beautyLayer = "transparent";
  transparent.depthChannel = "Z";
  ReadOptions transmission = transparent;
  transmission.beautyLayer = "transmission";
  const Image<glm::vec4> light = readOpaque(folder + "/out.exr", transparent).gbuffer.beauty;
  const Image<glm::vec4> through = readOpaque(folder + "/out.exr", transmission).gbuffer.beauty;
  for (std::size_t i = 0; i < picture.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float sum = light[i][c] + through[i][c] * background[i][c];
      ASSERT_LE(std::abs(sum - picture[i][c]), std::nextafter(sum, 1e9f) - sum) << i;
    }
}

TEST_F(Pipeline, InspectSaysWhatWasFound) {
  writeOpaque(folder + "/opaque.exr");
  const Ended text = run({"inspect", "opaque.exr"});
  EXPECT_NE(text.out.find("Z"), std::string::npos);
  const auto report = nlohmann::json::parse(run({"inspect", "opaque.exr", "--json"}).out);
  EXPECT_TRUE(report.is_object());
  EXPECT_FALSE(run({"inspect", "--devices"}).out.empty());
}

}  // namespace
}  // namespace pellucid
