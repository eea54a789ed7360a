// A decal on a floor far from the origin of the world, whose vertices say so themselves: it is in front of the floor
// as it would be at home, for what floats round of its coordinates is larger there than what float depth tells apart.
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

constexpr int kWide = 64, kHigh = 36;
constexpr double kFov = 40.0, kEyeHeight = 1.6875, kPitch = 12.0;  // degrees, metres

class FarContact : public ::testing::Test {
 protected:
  void SetUp() override { folder = freshFolder("pipeline-far-contact"); }

  // The floor from the eye, planar depth in closed form; nothing at all where there is none.
  void writeFloor(const std::string& path, bool there) const {
    const double pitch = kPitch * M_PI / 180.0, half = std::tan(0.5 * kFov * M_PI / 180.0);
    Image<float> z(kWide, kHigh, std::numeric_limits<float>::infinity()), grey(kWide, kHigh, 0.25f);
    for (int y = 0; y < kHigh && there; ++y) {
      const double down = std::sin(pitch) - (1.0 - 2.0 * (y + 0.5) / kHigh) * half * std::cos(pitch);
      for (int x = 0; x < kWide && down > 0.01; ++x) z.at(x, y) = static_cast<float>(kEyeHeight / down);
    }
    const Window window{0, 0, kWide, kHigh};
    writeLayers(path, window, window, {{"", {{"R", grey}, {"G", grey}, {"B", grey}, {"Z", z}}}});
  }
  // Light that the decal adds over the picture.
  double shown(bool there, const glm::dvec3& place, double above, const std::string& method, int passes) const {
    writeFloor(folder + "/floor.exr", there);
    const auto at = [&](double x, double y, double z) {
      const glm::dvec3 p = place + glm::dvec3(x, y, z);
      return std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    };
    writeGlb(folder + "/decal.glb", {Quad{at(-2.5, above, -4.0), {5, 0, 0}, {0, 0, -10}, unlit(1, 1, 1, 0.8f)}});
    Request request = requestOf(folder + "/floor.exr", folder + "/decal.glb");
    request.method = method;
    request.paint = paintOf(method);
    request.passes = passes;
    const double pitch = kPitch * M_PI / 180.0;
    const glm::dvec3 eye = place + glm::dvec3(0.0, kEyeHeight, 0.0);
    request.shot.camera =
        PlacedCamera{eye, eye + glm::dvec3(0.0, -std::sin(pitch), -std::cos(pitch)), {0.0, 1.0, 0.0}, kFov};
    const Image<glm::vec4> picture = Compositor(request).run(request).picture.rgba;
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) sum += static_cast<double>(picture[i].r) - 0.25;
    return sum;
  }
  std::string folder;
};

TEST_F(FarContact, WhatLiesOnTheFloorShowsAndWhatLiesUnderItDoesNot) {
  for (const double away : {0.0, 1024.0, 8192.0, 65536.0})
    for (const char* method : {"over", "phenomenological"})
      for (const int passes : {1, 4}) {
        SCOPED_TRACE(testing::Message() << away << " m, " << method << ", --aa " << passes);
        const glm::dvec3 place(away, 0.5 * away, -away);
        const double whole = shown(false, place, 0.0, method, passes);
        ASSERT_GT(whole, 10.0);
        EXPECT_NEAR(shown(true, place, 0.0, method, passes), whole, 1e-3 * whole);
        // A 128th of a metre: the least that floats tell apart at the farthest place.
        EXPECT_EQ(shown(true, place, -0.0078125, method, passes), 0.0);
      }
}

}  // namespace
}  // namespace pellucid
