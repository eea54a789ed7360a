// What a frame takes over from the one before changes no bit, and nothing that has changed is taken over.
#include <gtest/gtest.h>

#include <filesystem>

#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class KeptFrames : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-kept");
    files = writeShotFiles(folder);
    kept = std::make_shared<KeptWork>(-1);
  }
  Request request(int frame) const {
    Request request = requestOf(files.flat, files.scene);
    request.method = "over";
    request.paint = paintOf("over");
    request.passes = 2;
    request.shot.time.frame = frame;
    return request;
  }
  // The frame after those before it holds the bits of a run of its own.
  void expectOwnBits(const Request& asked, bool keepsPicture, bool keepsScene) {
    Compositor after(asked, nullptr, nullptr, kept);
    EXPECT_EQ(after.shot().keptPicture, keepsPicture);
    EXPECT_EQ(after.shot().keptScene, keepsScene);
    const Image<glm::vec4> picture = after.run(asked).picture.rgba, own = Compositor(asked).run(asked).picture.rgba;
    ASSERT_EQ(picture.size(), own.size());
    for (std::size_t i = 0; i < own.size(); ++i) ASSERT_EQ(picture[i], own[i]) << i;
  }
  // Another picture in the file's place.
  void repaint(float colour) const {
    const auto plane = [&](float value) { return Image<float>(kShotWidth, kShotHeight, value); };
    const Window window{0, 0, kShotWidth, kShotHeight};
    writeLayers(files.flat, window, window,
                {{"",
                  {{"R", plane(colour)},
                   {"G", plane(0.5f)},
                   {"B", plane(0.75f)},
                   {"A", plane(1.0f)},
                   {"Z", plane(19.0f + colour)}}}});
  }
  std::string folder;
  ShotFiles files;
  std::shared_ptr<KeptWork> kept;
};

TEST_F(KeptFrames, OnePictureAndAnAnimatedScene) {
  expectOwnBits(request(1), false, false);
  for (const int frame : {2, 12, 1}) expectOwnBits(request(frame), true, true);
  Request lit = request(5);
  lit.shadows.source = ShadowSource::rays;  // which decode what is streamed
  expectOwnBits(lit, true, lit.shot.scene.streamBytes == 0);
}

TEST_F(KeptFrames, MotionBlurLeavesTheSceneToTheNext) {
  Request blurred = request(3);
  openShutter(blurred);
  openLens(blurred);
  expectOwnBits(blurred, false, false);
  expectOwnBits(request(4), true, true);
  expectOwnBits(blurred, true, true);
}

TEST_F(KeptFrames, WhatHasChangedIsReadAgain) {
  expectOwnBits(request(1), false, false);
  repaint(0.125f);
  expectOwnBits(request(2), false, true);
  writeGlb(files.scene, {Quad{{-1.0f, -1.0f, -4.0f}, {1.2f, 0, 0}, {0, 2, 0}, unlit(0.9f, 0.1f, 0.1f, 0.5f)}});
  expectOwnBits(request(3), true, false);
  Request others = request(3);
  others.shot.scene.metresPerUnit = 0.5;
  expectOwnBits(others, false, false);  // the scene's camera is nearer too
  Request still = others;
  still.shot.time = ShotTime();
  still.shot.time.animations = {"none"};
  expectOwnBits(still, true, false);
  Request moved = still;
  moved.shot.camera = PlacedCamera{{0.5, 0.0, 1.0}, {0.0, 0.0, -4.0}, {0.0, 1.0, 0.0}, 40.0};
  expectOwnBits(moved, false, true);
  Request near = moved;
  near.shot.read.farValue = 10.0;
  expectOwnBits(near, false, true);
}

TEST_F(KeptFrames, AFrameThatFailsLeavesNothing) {
  expectOwnBits(request(1), false, false);
  Request broken = request(2);
  broken.shot.opaque = folder + "/missing.exr";
  EXPECT_THROW(Compositor(broken, nullptr, nullptr, kept), InputError);
  expectOwnBits(request(3), false, false);
}

TEST_F(KeptFrames, NotesNameTheFrame) {
  std::string said;
  for (const int frame : {1, 2}) {
    said.clear();
    const Request asked = request(frame);
    Compositor(
        asked, [&](const std::string& note) { said += note + "\n"; }, nullptr, kept)
        .run(asked);
    EXPECT_NE(said.find("plays moves"), std::string::npos) << said;
    EXPECT_NE(said.find("frame " + std::to_string(frame) + " (--frame)"), std::string::npos) << said;
  }
}

TEST_F(KeptFrames, DeepAndFlatPicturesInTurn) {
  Request deep = request(1);
  deep.shot.opaque = files.deepPicture;
  expectOwnBits(deep, false, false);
  expectOwnBits(deep, false, true);
  expectOwnBits(request(1), false, true);
  expectOwnBits(deep, false, true);
}

}  // namespace
}  // namespace pellucid
