// Whole kinds of pictures that the campaign once found wrong, against the reference.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/pictures/scene_parts.h"
#include "tests/pictures/trial.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;

class Mended : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = freshFolder("pictures-mended"); }

  static DrawnFlags flagsOf(int passes, const std::string& shape = "box", double radius = 0.5) {
    DrawnFlags flags;
    flags.passes = passes;
    flags.filter = {shape, radius};
    flags.words = {fmt::format("--aa={}", passes), fmt::format("--filter={}:{}", shape, radius)};
    return flags;
  }
  // Of all pixels that are not merely somewhere between what is seen in them.
  void expectRight(SceneMaker& maker, const DrawnFlags& flags) {
    const Outcome outcome = compositeAndJudge(maker.finish(), flags, folder_, kept_);
    EXPECT_TRUE(outcome.right()) << outcome.refusal << outcome.worst;
  }
  static PlacedMesh& pane(SceneMaker& maker, double z, const Vec3& colour, double alpha) {
    PlacedMesh& mesh = maker.place(quadSheet(20.0 * z, 20.0 * z), maker.at(0, 0, z), glm::dmat3(1.0));
    mesh.coat.colour = Vec4(colour, alpha);
    mesh.coat.bothSides = true;
    return mesh;
  }

  std::string folder_;
  std::shared_ptr<KeptWork> kept_ = std::make_shared<KeptWork>(-1);
};

// Depth of such labels, interpolated across a triangle, is off by more than a float's step.
TEST_F(Mended, LabelsOnSurfacesSeenFarAslant) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    Random random(100 + i);
    SceneMaker maker("decals", random, 10.0);
    maker.look(26, 22, 0.4);
    const double tilt = (81.0 + 0.4 * static_cast<double>(i)) * kRadiansPerDegree;
    const Vec3 normal(0.0, std::sin(tilt), std::cos(tilt)), middle = maker.at(0, -0.2, 10.0);
    const int floor = maker.plane(middle, normal);
    maker.placeOn({floor, 0}, quadSheet(8.0, 8.0), middle, facing(normal, 0.3 * static_cast<double>(i)));
    expectRight(maker, flagsOf(64, "box", 1.5));
  }
}

// What a steep floor hides above its edge to a wall is what the wall hides.
TEST_F(Mended, WhatLiesBehindAWallAboveASteepFloor) {
  for (std::uint64_t i = 0; i < 4; ++i)
    for (const int passes : {5, 16}) {
      SCOPED_TRACE(testing::Message() << i << ", " << passes << " passes");
      Random random(200 + i);
      SceneMaker maker("contact", random, 5.0);
      maker.look(24, 24, 0.4);
      maker.plane(maker.at(0, 0, 5.0), {0.05 * static_cast<double>(i), 0, 1});
      const double tilt = (81.0 + 0.5 * static_cast<double>(i)) * kRadiansPerDegree;
      maker.plane(maker.at(0, 0.1, 5.0), {0.2, std::sin(tilt), std::cos(tilt)});
      pane(maker, 6.0, {0.1, 0.9, 0.2}, 0.75);
      expectRight(maker, flagsOf(passes));
    }
}

// Towards the limb of a ball its depth falls away more and more steeply; that is no edge of another surface.
TEST_F(Mended, LimbsOfBallsBeforePanes) {
  for (std::uint64_t i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    Random random(300 + i);
    SceneMaker maker("shapes", random, 10.0);
    maker.look(32, 24, 0.4);
    const double radius = 1.0 + 0.2 * static_cast<double>(i);
    const int ball = maker.ball(maker.at(0.05, 0.03, 10.0), radius);
    maker.scene().numbers.solids[static_cast<std::size_t>(ball)].colour = {0.75, 0.5, 1.25};
    pane(maker, 15.0, {0.9, 0.3, 0.0}, 0.75);
    expectRight(maker, flagsOf(32));
  }
}

// Before nothing at all alpha is the share of a surface.
TEST_F(Mended, PostsBeforeNothingUnderWideFilters) {
  for (std::uint64_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    Random random(400 + i);
    SceneMaker maker("posts", random, 5.0);
    maker.look(32, 24, 0.4);
    maker.box(maker.at(0, 0, 5.0), facing({0, 0, 1}, 0.1 + 0.2 * static_cast<double>(i)), {0.8, 8.0, 0.001});
    pane(maker, 8.0, {0.0, 0.6, 0.9}, 0.9);
    expectRight(maker, flagsOf(16, i % 2 == 0 ? "triangle" : "gaussian", 1.359375));
  }
}

// Parallel rays see a pane up to the eye's plane, and no rasteriser rounds where that cuts it.
TEST_F(Mended, PanesThroughTheEyesPlaneOfParallelRays) {
  for (std::uint64_t i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    Random random(500 + i);
    SceneMaker maker("meshes", random, 100.0);
    maker.look(36, 28, 50.0, true);
    maker.plane(maker.at(0, 0, 200.0), {0, 0, 1});
    const double steep = (80.0 + static_cast<double>(i)) * kRadiansPerDegree, spin = 0.7 * static_cast<double>(i);
    const Vec3 normal(std::sin(steep) * std::cos(spin), std::sin(steep) * std::sin(spin), std::cos(steep));
    PlacedMesh& mesh = maker.place(quadSheet(400.0, 400.0), maker.at(0.01, 0.02, 0.0), facing(normal, 0.3));
    mesh.coat.colour = {0.1, 0.8, 0.3, 0.75};
    mesh.coat.bothSides = true;
    expectRight(maker, flagsOf(64));
  }
}

}  // namespace
}  // namespace pellucid::test
