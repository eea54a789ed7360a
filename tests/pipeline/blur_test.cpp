// Motion blur and depth of field against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "composite/pass_points.h"
#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"
#include "gbuffer/moved_depth.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/box_edge.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;
using nlohmann::json;

constexpr int kBlurSize = 64;
constexpr double kPerMetre = 16.0;  // pixels at the card's distance: the picture is z metres high at distance z
constexpr double kCardZ = 4.0;
const float kNoDepth = std::numeric_limits<float>::infinity();

std::string base64(const std::string& bytes) {
  const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= std::min<std::size_t>(bytes.size() - i, 3) ? letters[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

// A white unlit card at kCardZ whose lower left corner lies at the origin, and a camera; frame 0 to frame 24.
//   cardMoves, cameraMoves  along x, metres a frame
struct Card {
  double left = 0.0, bottom = -10.0, width = 20.0, height = 20.0;
  double cardMoves = 0.0, cameraMoves = 0.0;

  void write(const std::string& path) const {
    std::string bytes;
    const auto put = [&](std::initializer_list<double> values) {
      for (const double value : values) {
        const auto narrow = static_cast<float>(value);
        char four[4];
        std::memcpy(four, &narrow, 4);
        bytes.append(four, 4);
      }
    };
    const double z = -kCardZ, right = left + width, top = bottom + height;
    put({left, bottom, z, right, bottom, z, right, top, z, left, bottom, z, right, top, z, left, top, z});
    put({0, 1});  // seconds
    put({-12 * cardMoves, 0, 0, 12 * cardMoves, 0, 0});
    put({-12 * cameraMoves, 0, 0, 12 * cameraMoves, 0, 0});
    json file = {{"asset", {{"version", "2.0"}}}, {"extensionsUsed", {"KHR_materials_unlit"}}};
    file["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    file["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 72}},
                           {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 8}},
                           {{"buffer", 0}, {"byteOffset", 80}, {"byteLength", 24}},
                           {{"buffer", 0}, {"byteOffset", 104}, {"byteLength", 24}}};
    const auto accessor = [](int view, int count, const char* type) {
      return json{{"bufferView", view}, {"componentType", 5126}, {"count", count}, {"type", type}};
    };
    file["accessors"] = {accessor(0, 6, "VEC3"), accessor(1, 2, "SCALAR"), accessor(2, 2, "VEC3"),
                         accessor(3, 2, "VEC3")};
    file["materials"] = {{{"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
    file["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}};
    file["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 2.0 * std::atan(0.5)}, {"znear", 0.1}}}}};
    file["nodes"] = {{{"mesh", 0}}, {{"camera", 0}}};
    const auto channel = [](int sampler, int node) {
      return json{{"sampler", sampler}, {"target", {{"node", node}, {"path", "translation"}}}};
    };
    file["animations"] = {{{"channels", {channel(0, 0), channel(1, 1)}},
                           {"samplers", {{{"input", 1}, {"output", 2}}, {{"input", 1}, {"output", 3}}}}}};
    std::ofstream(path) << file.dump();
  }
};

class Blur : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-blur"); }

  // Black all over, of one depth.
  //   rows  in the middle of the picture, which alone are there
  void writePicture(float z, int rows = kBlurSize) const {
    const Image<float> black(kBlurSize, rows, 0.0f), one(kBlurSize, rows, 1.0f);
    const Window window{0, 0, kBlurSize, kBlurSize}, data{0, (kBlurSize - rows) / 2, kBlurSize, (kBlurSize + rows) / 2};
    writeLayers(
        folder + "/black.exr", window, data,
        {{"", {{"R", black}, {"G", black}, {"B", black}, {"A", one}, {"Z", Image<float>(kBlurSize, rows, z)}}}});
  }
  Request request(int passes) const {
    Request request = requestOf(folder + "/black.exr", folder + "/card.gltf");
    request.method = "over";
    request.paint = paintOf("over");
    request.passes = passes;
    request.shot.time.frame = 12;
    return request;
  }
  static Image<glm::vec4> run(const Request& request) { return Compositor(request).run(request).picture.rgba; }

  std::string folder;
};

// Sum, centre and second moment about it of what is lit, in pixels.
struct Moments {
  double sum = 0;
  glm::dvec2 centre{0.0}, variance{0.0};
};
Moments momentsOf(const Image<glm::vec4>& picture) {
  Moments m;
  for (const bool second : {false, true})
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const auto value = static_cast<double>(picture.at(x, y).r);
        const glm::dvec2 at(x + 0.5, y + 0.5);
        if (!second) {
          m.sum += value;
          m.centre += value * at;
        } else {
          m.variance += value * (at - m.centre / m.sum) * (at - m.centre / m.sum);
        }
      }
  m.centre /= m.sum;
  m.variance /= m.sum;
  return m;
}

// With so many passes that the steps of a pixel's edge, one for each of them, are below what is asked for.
constexpr int kManyPasses = 4096;

TEST_F(Blur, ACrossingPaneHasABoxBlurredEdge) {
  Card card;
  card.left = 0.11;
  card.cardMoves = 10.0 / kPerMetre;  // pixels a frame
  card.write(folder + "/card.gltf");
  writePicture(kNoDepth, 2);
  for (const auto& [open, close] : {std::pair(-0.5, 0.5), std::pair(-0.25, 0.25), std::pair(0.0, 1.0)}) {
    Request blurred = request(kManyPasses);
    blurred.shutter = Shutter{open, close, false};
    const Image<glm::vec4> picture = run(blurred);
    EXPECT_NEAR(boxWidth(picture, boxEdgePixel), 10.0 * (close - open), 0.01) << open << ":" << close;
    // Where the edge lies in the middle of the shutter.
    double lit = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) lit += static_cast<double>(picture[i].r) / picture.height();
    const double edge = kBlurSize / 2 + 0.11 * kPerMetre + 10.0 * 0.5 * (open + close);
    EXPECT_NEAR(lit, kBlurSize - edge, 0.01) << open << ":" << close;
  }
}

TEST_F(Blur, TheCameraBlursAsMuchTheOtherWay) {
  Card card;
  card.cameraMoves = -10.0 / kPerMetre;
  card.write(folder + "/card.gltf");
  writePicture(kNoDepth, 2);
  Request blurred = request(kManyPasses);
  blurred.shutter = Shutter{-0.5, 0.5, false};
  EXPECT_NEAR(boxWidth(run(blurred), boxEdgePixel), 10.0, 0.01);
  blurred.shutter->holdsCamera = true;
  EXPECT_NEAR(boxWidth(run(blurred), boxEdgePixel), 0.0, 0.1) << "held";
}

TEST_F(Blur, ErrorFallsWithThePasses) {
  Card card;
  card.cardMoves = 10.0 / kPerMetre;
  card.write(folder + "/card.gltf");
  writePicture(kNoDepth);
  double last = 1.0;
  for (const int passes : {4, 16, 64}) {
    Request blurred = request(passes);
    blurred.shutter = Shutter{-0.5, 0.5, false};
    const Image<glm::vec4> picture = run(blurred);
    double worst = 0;
    for (int x = 0; x < kBlurSize; ++x) {
      worst = std::max(worst, std::abs(static_cast<double>(picture.at(x, 5).r) - boxEdgePixel(x, kBlurSize / 2, 10.0)));
    }
    EXPECT_LT(worst, 0.6 * last) << passes;
    last = worst;
  }
  EXPECT_LT(last, 0.02);
}

TEST_F(Blur, APointOutOfFocusIsADisc) {
  Card card;
  card.left = -1.0 / kPerMetre + 0.003;
  card.bottom = -1.0 / kPerMetre + 0.007;
  card.width = card.height = 2.0 / kPerMetre;  // two pixels
  card.write(folder + "/card.gltf");
  writePicture(kNoDepth);
  const Moments sharp = momentsOf(run(request(256)));
  EXPECT_NEAR(sharp.sum, 4.0, 4e-3);
  for (const double focus : {8.0, 2.5, 1e6}) {
    Request blurred = request(256);
    blurred.lens.radius = 1.0;
    blurred.lens.focus = focus;
    const Moments disc = momentsOf(run(blurred));
    EXPECT_NEAR(disc.sum / sharp.sum, 1.0, 1e-3) << "highlights keep their energy";
    const double right = kBlurSize * std::abs(1.0 / kCardZ - 1.0 / focus);
    // A disc has a quarter of its radius squared along each axis.
    const glm::dvec2 spread = disc.variance - sharp.variance;
    EXPECT_NEAR(std::sqrt(2.0 * (spread.x + spread.y)), right, 0.1) << focus;
    EXPECT_NEAR(2.0 * std::sqrt(spread.x), right, 0.2) << focus;
    EXPECT_LT(glm::length(disc.centre - sharp.centre), 0.05) << focus;
  }
  Request inFocus = request(256);
  inFocus.lens.radius = 1.0;
  inFocus.lens.focus = kCardZ;
  EXPECT_NEAR(momentsOf(run(inFocus)).variance.x, sharp.variance.x, 0.01);
}

TEST_F(Blur, NothingOpenGivesTheSameBits) {
  Card card;
  card.left = 0.3;
  card.cardMoves = 1.0;
  card.write(folder + "/card.gltf");
  writePicture(5.0f);
  const Image<glm::vec4> plain = run(request(8));
  Request closed = request(8);
  closed.shutter = Shutter{0.0, 0.0, false};
  closed.lens.radius = 0.0;
  closed.lens.focus = 3.0;
  const Image<glm::vec4> same = run(closed);
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_EQ(plain[i], same[i]);
}

TEST_F(Blur, TheShotStandsAsItStoodAfterwards) {
  Card card;
  card.left = 0.3;
  card.cardMoves = 0.5;
  card.cameraMoves = 0.25;
  card.write(folder + "/card.gltf");
  writePicture(5.0f);
  const Request still = request(4);
  Request blurred = still;
  blurred.shutter = Shutter{-0.5, 0.5, false};
  blurred.lens.radius = 0.3;
  blurred.lens.focus = 3.0;
  Compositor compositor(still);
  const Image<glm::vec4> before = compositor.run(still).picture.rgba;
  const Image<glm::vec4> once = compositor.run(blurred).picture.rgba, again = compositor.run(blurred).picture.rgba;
  const Image<glm::vec4> after = compositor.run(still).picture.rgba;
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(before[i], after[i]);
    ASSERT_EQ(once[i], again[i]);
  }
}

// What stands before the card hides it from every point of the lens, by its own depth as that point has it.
TEST_F(Blur, TheOpaqueDepthIsSeenThroughTheLens) {
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, kBlurSize, kBlurSize};
  gbuffer.viewZ = Image<float>(kBlurSize, kBlurSize, 8.0f);
  for (int y = 0; y < kBlurSize; ++y)
    for (int x = 0; x < kBlurSize / 2; ++x) gbuffer.viewZ.at(x, y) = 2.0f;
  Camera camera;
  camera.focal = {2.0, 2.0};
  const DepthPlanes planes(gbuffer, camera);
  Lens lens;
  lens.radius = 1.0;
  lens.focus = 4.0;
  for (const double at : {-0.5, 0.25, 0.5}) {
    const Camera from = throughLens(camera, lens, {at, 0.0});
    Image<float> moved(kBlurSize, kBlurSize);
    depthFrom(planes, gbuffer, camera, from, {0.5, 0.5}, moved);
    // Nearer than what is in focus things go against the lens: an edge at the middle of the picture by this.
    const double shift = kBlurSize * at * (1.0 / lens.focus - 1.0 / 2.0), edge = kBlurSize / 2 + shift;
    for (int x = 0; x < kBlurSize; ++x) {
      if (std::abs(x + 0.5 - edge) < 0.51) continue;
      // Farther things go with it, and uncover nothing where they follow.
      EXPECT_NEAR(moved.at(x, 20), x + 0.5 < edge ? 2.0f : 8.0f, 1e-4f) << at << " " << x;
    }
  }
}

TEST(PassPoints, StratifiedAndWithoutALean) {
  for (const int count : {2, 3, 4, 8, 16, 24, 64, 100, 256, 512}) {
    const std::vector<PassPoint> points = passPoints(count);
    ASSERT_EQ(points.size(), static_cast<std::size_t>(count));
    std::vector<bool> taken(points.size(), false);
    for (const PassPoint& point : points) {
      const auto part = static_cast<std::size_t>(point.time * count);
      ASSERT_LT(part, points.size());
      EXPECT_FALSE(taken[part]) << "one pass in each part of the time";
      taken[part] = true;
      EXPECT_GE(point.lens.x, 0.0);
      EXPECT_LT(point.lens.x, 1.0);
      EXPECT_LE(glm::length(lensPoint(point.lens, 0)), 1.0 + 1e-12);
      EXPECT_LE(glm::length(lensPoint(point.lens, 5)), 1.0 + 1e-12);
    }
  }
  EXPECT_EQ(passPoints(1)[0].time, 0.5);
}

TEST(Lens, WhatContradictsItselfIsRefused) {
  const auto refusal = [](const std::function<void(LensRequest&)>& change) {
    LensRequest request;
    request.radius = 0.1;
    request.focus = 2.0;
    change(request);
    try {
      checkLens(request);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal([](LensRequest&) {}), "");
  EXPECT_NE(refusal([](LensRequest& r) { r.fStop = 2.0; }).find("--f-stop"), std::string::npos);
  EXPECT_NE(refusal([](LensRequest& r) { r.focus.reset(); }).find("--focus"), std::string::npos);
  EXPECT_NE(refusal([](LensRequest& r) { r.radius.reset(); }).find("--focus"), std::string::npos);
  EXPECT_NE(refusal([](LensRequest& r) { r.radius = -1.0; }).find("--lens-radius"), std::string::npos);
  EXPECT_NE(refusal([](LensRequest& r) { r.blades = 2; }).find("--lens-blades"), std::string::npos);
  EXPECT_NE(refusal([](LensRequest& r) { r.focalLength = 50.0; }).find("--focal-length"), std::string::npos);
}

}  // namespace
}  // namespace pellucid
