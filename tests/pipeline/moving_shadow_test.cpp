// The shadow of something that moves while the shutter is open, against its closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include "composite/antialias.h"
#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "engine_bridge/embree/sampling.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/box_edge.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// A wall that a sun lights from behind the camera, where a card moves across its light: nothing of it is in the
// picture but its shadow.
constexpr int kWallSize = 64, kRows = 2;
constexpr float kWallZ = 8.0f;                     // metres; the picture is as high there
constexpr double kWallPerMetre = kWallSize / 8.0;  // pixels on the wall
constexpr double kPixelsPerFrame = 10.0;
constexpr double kCardEdge = 0.11;  // metres, of the card's edge at the frame
constexpr int kShadowSamples = 4;   // positions in a pixel that a pass asks at

class MovingShadow : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-moving-shadow");
    const Image<float> light(kWallSize, kRows, 1.0f), depth(kWallSize, kRows, kWallZ);
    const Window window{0, 0, kWallSize, kWallSize}, data{0, kWallSize / 2 - 1, kWallSize, kWallSize / 2 + 1};
    const std::vector<std::pair<std::string, Image<float>>> lit{{"R", light}, {"G", light}, {"B", light}};
    auto beauty = lit;
    beauty.insert(beauty.end(), {{"A", light}, {"Z", depth}});
    writeLayers(folder + "/wall.exr", window, data, {{"", beauty}, {"light.sun", lit}});

    const auto perSecond = static_cast<float>(kPixelsPerFrame / kWallPerMetre * 24.0);
    const float width = 6.0f,
                right = static_cast<float>(kCardEdge) - 0.5f * perSecond;  // the frame is at half a second
    GlbOptions options;
    options.motions = {{0, {perSecond, 0.0f, 0.0f}}};
    options.extra = {
        {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_unlit"}},
        {"extensions",
         {{"KHR_lights_punctual", {{"lights", {{{"name", "sun"}, {"type", "directional"}, {"intensity", 1000.0}}}}}}}}};
    options.nodes =
        nlohmann::json::array({{{"name", "sun"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
    writeGlb(folder + "/card.glb", {Quad{{right - width, -3.0f, 2.0f}, {width, 0, 0}, {0, 6.0f, 0}, unlit(1, 1, 1, 1)}},
             options);
  }
  Request request(ShadowSource source, int passes, double open, double close) const {
    Request request = requestOf(folder + "/wall.exr", folder + "/card.glb");
    request.method = "over";
    request.paint = paintOf("over");
    request.passes = passes;
    request.shot.time.frame = 12;
    request.shutter = Shutter{open, close, false};
    request.shadows.source = source;
    return request;
  }
  std::string folder;
};

// Where in a pixel a pass asks, from its left border.
using Positions = std::vector<double>;
Positions positionsOfRays() {
  Positions positions;
  for (std::uint32_t k = 0; k < kShadowSamples; ++k)
    positions.push_back(static_cast<double>(rays::samplePoint(k, 0).x));
  return positions;
}
Positions positionsOfMaps() {
  Positions positions;
  for (int k = 0; k < kShadowSamples; ++k) positions.push_back(samplePosition(k, kShadowSamples).x);
  return positions;
}

double litPixels(const Image<glm::vec4>& picture) {
  double lit = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i) lit += static_cast<double>(picture[i].r) / picture.height();
  return lit;
}

void expectEdge(const Image<glm::vec4>& picture, const Positions& positions, double open, double close,
                const char* name) {
  const double mean = std::accumulate(positions.begin(), positions.end(), 0.0) / kShadowSamples;
  const auto pixel = [&](int x, double centre, double width) {
    double sum = 0.0;
    for (const double position : positions)
      sum += std::clamp((x + position - (centre + mean - 0.5)) / width + 0.5, 0.0, 1.0);
    return sum / kShadowSamples;
  };
  const double width = boxWidth(picture, pixel), expected = kPixelsPerFrame * (close - open);
  const double edge = kWallSize - litPixels(picture) + mean - 0.5;
  const double middle = kWallSize / 2 + kWallPerMetre * kCardEdge + kPixelsPerFrame * 0.5 * (open + close);
  std::printf("[ figure ] %s, %g:%g: %.4f px wide, %.4f expected; edge at %.4f px, %.4f expected\n", name, open, close,
              width, expected, edge, middle);
  EXPECT_NEAR(width, expected, 0.01) << name;
  EXPECT_NEAR(edge, middle, 0.01) << name;
}

// With so many passes that their steps, one for each, do not show in the width.
TEST_F(MovingShadow, ByRaysIsABoxBlurredEdge) {
  for (const auto& [open, close] : {std::pair(-0.5, 0.5), std::pair(0.0, 0.5)}) {
    const Request blurred = request(ShadowSource::rays, 512, open, close);
    expectEdge(Compositor(blurred).run(blurred).picture.rgba, positionsOfRays(), open, close, "rays");
  }
}

// A map filters the edge over some of its texels, which are small enough here.
TEST_F(MovingShadow, ByMapsIsABoxBlurredEdge) {
  Request blurred = request(ShadowSource::maps, 32, -0.5, 0.5);
  blurred.shadows.size = 2048;
  expectEdge(Compositor(blurred).run(blurred).picture.rgba, positionsOfMaps(), -0.5, 0.5, "maps");
}

TEST_F(MovingShadow, InTwoStepsIsTheSame) {
  Request blurred = request(ShadowSource::rays, 4, -0.5, 0.5);
  blurred.method = "phenomenological";
  blurred.paint = PaintSums{};
  const Image<glm::vec4> once = Compositor(blurred).run(blurred).picture.rgba;
  std::vector<PassPlanes> passes;
  Compositor(blurred).accumulate(blurred, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
  writePasses(folder + "/planes.exr", passes);
  PlanesRequest resolve;
  resolve.opaque = blurred.shot.opaque;
  resolve.planes = {folder + "/planes.exr"};
  Journal journal;
  const Image<glm::vec4> twice = resolvePlanes(resolve, journal).picture.rgba;
  std::size_t shadowed = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    ASSERT_EQ(once[i], twice[i]);
    if (once[i].r > 0.0f && once[i].r < 1.0f) ++shadowed;
  }
  EXPECT_GT(shadowed, 10u) << "the edge is blurred in both";
}

}  // namespace
}  // namespace pellucid
