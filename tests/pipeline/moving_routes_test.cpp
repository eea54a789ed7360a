// What moves from pass to pass, by the shutter or through the lens, moves by every route that paints it: one layer is
// the same picture by all of them.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/pipeline/compositor.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class MovingRoutes : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-moving-routes");
    files = writeShotFiles(folder);
    GlbOptions options;
    options.motions = {{0, {4.0f, 0.0f, 0.0f}}};
    writeGlb(folder + "/card.glb", {Quad{{-1, -1, -4}, {1.5f, 0, 0}, {0, 2, 0}, unlit(1, 0.5f, 0.25f, 0.6f)}}, options);
  }
  Request request() const {
    Request asked = requestOf(files.flat, folder + "/card.glb");
    asked.passes = 4;
    return asked;
  }
  static Image<glm::vec4> shown(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request).picture.rgba;
  }
  ShotFiles files;
  std::string folder;
};

TEST_F(MovingRoutes, ShowOneLayerAtTheSamePlaces) {
  const auto bySystems = [](SystemRule rule) {
    PaintSystems systems;
    systems.rule = rule;
    return systems;
  };
  PaintSamples onDevice;
  onDevice.settings.samples = 64;
  onDevice.onDevice = true;
  const std::pair<const char*, Paint> routes[] = {{"sums", PaintSums{}},
                                                  {"systems, files", bySystems(SystemRule::file)},
                                                  {"systems, nodes", bySystems(SystemRule::node)},
                                                  {"samples on the device", onDevice}};
  for (const bool shutter : {true, false})
    for (const bool lens : {true, false}) {
      Request truth = request();
      if (shutter) openShutter(truth);
      if (lens) openLens(truth);
      truth.paint = PaintSorted{};
      const Image<glm::vec4> sorted = shown(truth);
      if (shutter || lens) {
        Request still = request();
        still.shot.time = truth.shot.time;
        still.paint = PaintSorted{};
        EXPECT_GT(farthestApart(sorted, shown(still)), 0.05) << "something moves";
      }
      for (const auto& [name, paint] : routes) {
        Request routed = truth;
        routed.paint = paint;
        EXPECT_LT(farthestApart(sorted, shown(routed)), 3e-5) << name << ", shutter " << shutter << ", lens " << lens;
      }
    }
}

}  // namespace
}  // namespace pellucid
