// Layers that lie on an opaque surface are in front of it, and what lies behind it is hidden, wherever in the pixel a
// pass samples: by every method, at any tilt and distance, as far as the depth's precision tells them apart.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "composite/pipeline/compositor.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kContactSize = 24;
constexpr float kNoSurface = std::numeric_limits<float>::infinity();
constexpr glm::dvec3 kColour{0.2, 0.4, 0.6};

struct Wall {
  double tilt, distance;  // degrees about an upright axis; metres on the camera's axis
  bool half;
  double decal = 0.4;  // half of the square's edge, parts of the distance
  double precision() const { return half ? 0x1p-10 : 0x1p-20; }
};

// The picture of the wall, or of nothing at all, as the camera of writeGlb() sees it.
void writeWall(const std::string& path, const Wall& wall, bool there) {
  const double t = wall.tilt * M_PI / 180.0;
  Image<float> z(kContactSize, kContactSize);
  for (int y = 0; y < kContactSize; ++y)
    for (int x = 0; x < kContactSize; ++x) {
      const double across = (x + 0.5) / kContactSize - 0.5, facing = std::cos(t) - std::sin(t) * across;
      z.at(x, y) = there && facing > 0.0 ? static_cast<float>(wall.distance * std::cos(t) / facing) : kNoSurface;
    }
  const auto plane = [](double value) { return Image<float>(kContactSize, kContactSize, static_cast<float>(value)); };
  const Window window{0, 0, kContactSize, kContactSize};
  writeLayers(path, window, window,
              {{"", {{"R", plane(kColour.r)}, {"G", plane(kColour.g)}, {"B", plane(kColour.b)}, {"Z", z}}}}, {},
              nullptr, wall.half);
}

// A square on the wall; `scale` moves it along the eye's rays.
void writeDecal(const std::string& path, const Wall& wall, double scale, const nlohmann::json& material) {
  const double t = wall.tilt * M_PI / 180.0, s = wall.decal * wall.distance;
  const glm::dvec3 across(std::cos(t), 0.0, -std::sin(t)), up(0.0, 1.0, 0.0);
  const auto put = [&](const glm::dvec3& v) {
    const glm::dvec3 scaled = v * scale;
    return std::array<float, 3>{static_cast<float>(scaled.x), static_cast<float>(scaled.y),
                                static_cast<float>(scaled.z)};
  };
  writeGlb(path, {Quad{put(glm::dvec3(0.0, 0.0, -wall.distance) - s * (across + up)), put(2.0 * s * across),
                       put(2.0 * s * up), material}});
}

class Contact : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-contact"); }
  Image<glm::vec4> picture(bool there, double scale, const Wall& wall, const std::string& method, int passes,
                           bool low = false) {
    nlohmann::json material = unlit(1.0f, 0.5f, 0.25f, 0.5f);
    if (low) material["extras"] = {{"pellucid", {{"lowResolution", true}}}};
    writeWall(folder + "/wall.exr", wall, there);
    writeDecal(folder + "/decal.glb", wall, scale, material);
    Request request = requestOf(folder + "/wall.exr", folder + "/decal.glb");
    request.method = method;
    request.paint = paintOf(method);
    if (auto* samples = std::get_if<PaintSamples>(&request.paint)) samples->settings.samples = 64;
    request.passes = passes;
    if (low) request.lowResolution.factor = lowFactor;
    return run(request);
  }
  static Image<glm::vec4> run(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture.rgba;
  }
  // On the wall as before nothing, to the bit; behind it not at all.
  void expectContact(const Wall& wall, const std::string& method, int passes, bool low = false) {
    SCOPED_TRACE(testing::Message() << wall.tilt << " degrees, " << wall.distance << " m, half " << wall.half << ", "
                                    << method << ", --aa " << passes);
    const Image<glm::vec4> on = picture(true, 1.0, wall, method, passes, low);
    EXPECT_EQ(farthestApart(on, picture(false, 1.0, wall, method, passes, low)), 0.0);
    const Image<glm::vec4> behind = picture(true, 1.0 + 2.0 * wall.precision(), wall, method, passes, low);
    writeGlb(folder + "/decal.glb", {Quad{{0, 0, 9}, {1, 0, 0}, {0, 1, 0}, unlit(1, 1, 1, 0.5f)}});
    Request none = requestOf(folder + "/wall.exr", folder + "/decal.glb");
    EXPECT_EQ(farthestApart(behind, run(none)), 0.0);
    EXPECT_GT(farthestApart(on, behind), 0.1) << "there is something to see";
  }
  std::string folder;
  int lowFactor = LowResolutionRequest::kDefault;
};

TEST_F(Contact, AtAnyTiltAndDistance) {
  for (const double tilt : {0.0, 30.0, 60.0, 80.0})
    for (const double distance : {0.05, 5000.0})
      for (const bool half : {false, true}) expectContact({tilt, distance, half}, "over", 8);
}

TEST_F(Contact, WithAnyNumberOfPasses) {
  for (const int passes : {1, 2, 3, 16, 64}) expectContact({-50.0, 5.0, true}, "over", passes);
}

TEST_F(Contact, ByEveryMethod) {
  for (const char* method : {"phenomenological", "weighted", "average", "sum", "mlab:4", "moments:4", "wavelet:2",
                             "front+tail", "stochastic"})
    expectContact({70.0, 5.0, false}, method, 8);
}

TEST_F(Contact, ByEveryRoute) {
  const Wall wall{70.0, 5.0, false};
  const auto each = [&](Request& request, int route) {
    request.passes = 8;
    if (route == 0) request.tier = Tier::exact;
    if (route == 1) request.tier = Tier::published;
    if (route == 2) request.paint = PaintSystems{};
    if (route == 3) request.paint = PaintWithin{0.01};
    if (route == 4) {
      request.paint = PaintSamples{};
      std::get<PaintSamples>(request.paint).onDevice = true;
    }
  };
  for (int route = 0; route < 5; ++route) {
    SCOPED_TRACE(route);
    Image<glm::vec4> shown[3];
    for (int k = 0; k < 3; ++k) {
      writeWall(folder + "/wall.exr", wall, k != 1);
      writeDecal(folder + "/decal.glb", wall, k == 2 ? 1.0 + 2.0 * wall.precision() : 1.0,
                 unlit(1.0f, 0.5f, 0.25f, 0.5f));
      Request request = requestOf(folder + "/wall.exr", folder + "/decal.glb");
      each(request, route);
      shown[k] = run(request);
    }
    EXPECT_EQ(farthestApart(shown[0], shown[1]), 0.0);
    for (std::size_t i = 0; i < shown[2].size(); ++i)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(shown[2][i][c], static_cast<float>(kColour[c]));
  }
}

// At low resolution texels are larger than pixels, and a slanted wall goes far within one: layers on it are met where
// the texel's sample lies. Of the decal the inner pixels, around which it covers all texels that reach them. Behind the
// wall by more than its corners, which lie on a grid of 1/256 texel, move it. Texels at
// another depth, beyond the decal, enter with some millionths.
TEST_F(Contact, AtLowResolution) {
  for (const double tilt : {0.0, -40.0, 60.0, 75.0})
    for (const bool half : {false, true})
      for (const int factor : {2, 4})
        for (const int passes : {1, 8})
          for (const char* method : {"over", "phenomenological"}) {
            const Wall wall{tilt, 5.0, half, 0.8};
            const int middle = tilt > 0.0 ? 8 : tilt < 0.0 ? 16 : 12;  // where the wall is near
            SCOPED_TRACE(testing::Message() << tilt << " degrees, half " << half << ", --low-res " << factor
                                            << ", --aa " << passes << ", " << method);
            lowFactor = factor;
            const Image<glm::vec4> on = picture(true, 1.0, wall, method, passes, true);
            const double slope = std::tan(std::abs(tilt) * M_PI / 180.0) / kContactSize,
                         scale = 1.0 + 16.0 * wall.precision() + 8.0 * slope * factor / 256.0;
            const Image<glm::vec4> behind = picture(true, scale, wall, method, passes, true);
            for (int y = 0; y < kContactSize; ++y)
              for (int x = 0; x < kContactSize; ++x)
                for (int c = 0; c < 3; ++c) {
                  if (tilt * (x + 0.5 - kContactSize / 2) > 0.0) continue;  // there it slants more than in the middle
                  EXPECT_NEAR(behind.at(x, y)[c], kColour[c], half ? 1e-4 : 1e-6) << x << " " << y;
                  if (std::abs(x - middle) > 1 || std::abs(y - kContactSize / 2) > 1) continue;
                  const double shown = 0.5 * glm::dvec3(1.0, 0.5, 0.25)[c] + 0.5 * kColour[c];
                  EXPECT_NEAR(on.at(x, y)[c], shown, half ? 1e-4 : 1e-5) << x << " " << y;
                }
            if (HasFailure()) return;
          }
}

}  // namespace
}  // namespace pellucid
