// The renderer's pixel filter: passes drawn from it filter layers as the picture was filtered, our own G-buffers too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "composite/antialias.h"
#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kFilterSize = 24;
constexpr double kTurn = 0.37;  // radians, of the edge against the picture's columns

// The filters' densities along one axis as their authors print them, not normalised: nothing of ours.
struct Density {
  const char* text;
  double radius;
  std::function<double(double)> at;
};
const std::vector<Density>& densities() {
  const auto harris = [](double radius) {
    return [radius](double x) {
      const double n = std::numbers::pi * (x / radius + 1.0);
      return 0.35875 - 0.48829 * std::cos(n) + 0.14128 * std::cos(2.0 * n) - 0.01168 * std::cos(3.0 * n);
    };
  };
  static const std::vector<Density> all{{"box", 0.5, [](double) { return 1.0; }},
                                        {"box:1", 1.0, [](double) { return 1.0; }},
                                        {"triangle", 1.0, [](double x) { return 1.0 - std::abs(x); }},
                                        {"gaussian", 1.5, [](double x) { return std::exp(-2.0 * x * x); }},
                                        {"gaussian:0.75", 0.75, [](double x) { return std::exp(-8.0 * x * x); }},
                                        {"blackman-harris", 1.5, harris(1.5)},
                                        {"blackman-harris:0.75", 0.75, harris(0.75)}};
  return all;
}

// Part of a pixel's filter that lies where across . (x - centre) is below `distance`, by quadrature.
double belowLine(const Density& density, glm::dvec2 across, double distance) {
  constexpr int kSteps = 400;  // along each axis
  double sum = 0.0, below = 0.0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const glm::dvec2 at = ((glm::dvec2(i, j) + 0.5) * (2.0 / kSteps) - 1.0) * density.radius;
      const double weight = density.at(at.x) * density.at(at.y);
      sum += weight;
      if (glm::dot(across, at) < distance) below += weight;
    }
  return below / sum;
}

class Filters : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-filters"); }
  std::string path(const char* name) const { return folder + "/" + name; }

  // Left of an edge through the picture's middle stands a white sheet 2 m away; a pixel is 2 / kFilterSize metres
  // there.
  void writeSheet(const char* name, const char* mode, double turn = kTurn) const {
    const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
    nlohmann::json white = unlit(1, 1, 1, 1);
    white["alphaMode"] = mode;
    writeGlb(path(name), {Quad{{8 * s - 8 * c, -8 * s - 8 * c, -2}, {8 * c, 8 * s, 0}, {-16 * s, 16 * c, 0}, white}});
  }
  // Black, 10 m away.
  void writeWall(const std::map<std::string, std::string>& attributes = {}, const std::string& layer = "") const {
    const Image<float> black(kFilterSize, kFilterSize, 0.0f), opaque(kFilterSize, kFilterSize, 1.0f),
        far(kFilterSize, kFilterSize, 10.0f);
    const Window window{0, 0, kFilterSize, kFilterSize};
    const std::string beauty = layer.empty() ? "" : layer + ".Combined";
    std::vector<ExtraLayer> layers{{beauty, {{"R", black}, {"G", black}, {"B", black}, {"A", opaque}}}};
    if (layer.empty())
      layers[0].channels.emplace_back("Z", far);
    else
      layers.push_back({layer + ".Depth", {{"Z", far}}});
    writeLayers(path("wall.exr"), window, window, layers, attributes);
  }
  static Image<glm::vec4> run(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture.rgba;
  }
  // Distance of the edge from a pixel's centre, along `across`, pixels; the sheet lies where it is positive.
  static glm::dvec2 across() { return {std::cos(kTurn), -std::sin(kTurn)}; }
  static double distanceAt(int x, int y) {
    return -glm::dot(across(), glm::dvec2(x + 0.5 - kFilterSize / 2, y + 0.5 - kFilterSize / 2));
  }
  double worst(const Density& density, const std::function<double(int, int)>& white) const {
    double off = 0.0;
    for (int y = 4; y < kFilterSize - 4; ++y)
      for (int x = 0; x < kFilterSize; ++x) {
        const double distance = distanceAt(x, y);
        if (std::abs(distance) > 2.0 * density.radius + 1.0) continue;
        off = std::max(off, std::abs(white(x, y) - belowLine(density, across(), distance)));
      }
    return off;
  }
  std::string folder;
};

// N places leave a straight edge uncertain by a few of them.
TEST_F(Filters, TheLineSpreadOfASlantedEdgeIsTheFiltersIntegral) {
  writeWall();
  writeSheet("sheet.glb", "BLEND");
  for (const Density& density : densities()) {
    Request request = requestOf(path("wall.exr"), path("sheet.glb"));
    request.paint = PaintSorted{};
    request.passes = density.radius < 1.0 ? 256 : 1024;
    request.pixelFilter = parsePixelFilter(density.text);
    const Image<glm::vec4> picture = run(request);
    const double off = worst(density, [&](int x, int y) { return static_cast<double>(picture.at(x, y).r); });
    std::printf("[ figure ] %s: line spread within %.4f\n", density.text, off);
    EXPECT_LE(off, 0.01) << density.text;
  }
}

// By rays, whose samples have noise: 4096 of them, well spread.
TEST_F(Filters, OurOwnGBuffersAreFilteredAlike) {
  writeSheet("opaque.glb", "OPAQUE");
  for (const Density& density : densities()) {
    const Ended made = runProgram({"gbuffer", path("opaque.glb"), "-o", path("g.exr"), "--size", "24x24", "--samples",
                                   "4096", "--ao-radius", "0", "--filter", density.text});
    ASSERT_EQ(made.code, 0) << made.err;
    const OpaqueFile file = readOpaque(path("g.exr"), {});
    const double off =
        worst(density, [&](int x, int y) { return static_cast<double>(file.gbuffer.beauty.at(x, y).r); });
    std::printf("[ figure ] gbuffer, %s: line spread within %.4f\n", density.text, off);
    EXPECT_LE(off, 0.01) << density.text;
    const PixelFilter filter = parsePixelFilter(density.text);
    if (filter.isPixelSquare()) {
      EXPECT_FALSE(file.choice.pixelFilter);
    } else {
      EXPECT_EQ(file.choice.pixelFilter, filter) << "the header says so, and composite follows it";
    }
  }
}

TEST_F(Filters, TheBoxChangesNoBit) {
  writeWall();
  writeSheet("sheet.glb", "BLEND");
  Request request = requestOf(path("wall.exr"), path("sheet.glb"));
  request.paint = PaintSorted{};
  for (const int passes : {2, 8, 16, 17}) {
    request.passes = passes;
    request.pixelFilter.reset();
    const Image<glm::vec4> plain = run(request);
    for (const char* text : {"box", "box:0.5"}) {
      request.pixelFilter = parsePixelFilter(text);
      const Image<glm::vec4> boxed = run(request);
      for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_EQ(plain[i], boxed[i]) << text;
    }
    for (int i = 0; i < passes; ++i)
      EXPECT_EQ(samplePosition(i, passes), samplePosition(i, passes, parsePixelFilter("box")));
  }
}

TEST_F(Filters, TwoStepsAreOne) {
  writeWall();
  writeSheet("sheet.glb", "BLEND");
  Request request = requestOf(path("wall.exr"), path("sheet.glb"));
  request.passes = 8;
  request.pixelFilter = parsePixelFilter("blackman-harris");
  const Image<glm::vec4> once = run(request);
  const auto accumulated = [&](const char* name) {
    Compositor compositor(request);
    std::vector<PassPlanes> passes;
    compositor.accumulate(request, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
    writePasses(path(name), passes);
  };
  accumulated("planes.exr");
  EXPECT_EQ(readPasses(path("planes.exr"))[3].pixelFilter, *request.pixelFilter);
  Journal journal;
  PlanesRequest resolve;
  resolve.opaque = request.shot.opaque;
  resolve.planes = {path("planes.exr")};
  const Image<glm::vec4> twice = resolvePlanes(resolve, journal).picture.rgba;
  for (std::size_t i = 0; i < once.size(); ++i) ASSERT_EQ(once[i], twice[i]);
  request.pixelFilter.reset();
  accumulated("boxed.exr");
  resolve.planes.push_back(path("boxed.exr"));
  EXPECT_THROW(resolvePlanes(resolve, journal), MeaningError);
}

TEST_F(Filters, ThePictureSaysWhich) {
  writeSheet("sheet.glb", "BLEND");
  const auto said = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"composite", path("wall.exr"), path("sheet.glb"), "-o", path("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = runProgram(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.err;
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  writeWall({{"BlenderMultiChannel", "Blender V2.55.1 and newer"}}, "ViewLayer");
  EXPECT_TRUE(has(said({}), "filter: blackman-harris:1.5, which Blender"));
  EXPECT_FALSE(has(said({"--filter", "box"}), "filter:"));
  EXPECT_FALSE(has(said({"--aa", "1"}), "filter:")) << "pixel centres";
  writeWall({{"pellucid:filter", "triangle:1"}});
  EXPECT_TRUE(has(said({}), "filter: triangle:1, as the picture's header says"));
  writeWall({{"pellucid:filter", "triangle:-1"}});
  EXPECT_TRUE(has(said({}), "not taken"));
  writeWall();
  EXPECT_FALSE(has(said({}), "filter"));
}

TEST_F(Filters, WhatIsNoneIsRefused) {
  for (const char* text : {"", "Box", "mitchell", "lanczos:3", "box:", "box:0", "box:-1", "box:1px", "triangle:nan",
                           "gaussian:9", "gaussian:1e999", "gaussian:1:2", "box :1"})
    EXPECT_THROW(parsePixelFilter(text), UsageError) << text;
  for (const char* text : {"box:0.5", "triangle:1", "gaussian:1.5", "blackman-harris:1.5", "box:8", "gaussian:0.1"})
    EXPECT_EQ(filterText(parsePixelFilter(text)), text);
  const auto ended = [](std::vector<std::string> more) {
    std::vector<std::string> arguments{"composite", "none.exr", "none.glb", "-o", "out.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  };
  const Ended negative = ended({"--filter", "mitchell"});
  EXPECT_EQ(negative.code, 2);
  EXPECT_NE(negative.err.find("a filter with negative parts is no density to draw places from"), std::string::npos)
      << negative.err;
  EXPECT_EQ(ended({"--filter", "box", "--aa", "1"}).code, 2);
  EXPECT_EQ(
      runProgram({"gbuffer", "none.glb", "-o", "g.exr", "--size", "8x8", "--renderer", "gl", "--filter", "box"}).code,
      2);
  EXPECT_EQ(
      runProgram({"gbuffer", "none.glb", "-o", "g.exr", "--size", "8x8", "--samples", "1", "--filter", "box"}).code, 2);
}

}  // namespace
}  // namespace pellucid
