// A run that changes nothing says so, and why. Cameras that are one camera.
#include <gtest/gtest.h>

#include "gbuffer/deep_io.h"
#include "gbuffer/exr_document.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// Half covering, unlit; `mode` is glTF's alphaMode.
Quad pane(float z, const std::string& mode = "BLEND", float x = -50.0f) {
  Quad quad{{x, -50, z}, {100, 0, 0}, {0, 100, 0}, unlit(1, 0, 0, .5f)};
  quad.material["alphaMode"] = mode;
  return quad;
}

class NothingDrawn : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("nothing-drawn");
    writeOpaque(folder + "/opaque.exr", {.width = 16, .height = 16});
  }
  Ended run(const std::vector<std::string>& arguments) {
    RunOptions options;
    options.folder = folder;
    return runProgram(arguments, options);
  }
  // Every verb that draws says `why` of the scene, and the picture keeps its pixels.
  void expectSaid(const std::vector<Quad>& quads, const std::string& why) {
    writeGlb(folder + "/scene.glb", quads);
    for (const std::vector<std::string>& verb : {std::vector<std::string>{"composite", "-o", "out.exr"},
                                                 {"composite", "-o", "out.exr", "--method", "phenomenological"},
                                                 {"accumulate", "-o", "planes.exr"},
                                                 {"fragments", "-o", "deep.exr"},
                                                 {"study", "-o", "report", "--methods", "sum"}}) {
      std::vector<std::string> arguments{verb[0], "opaque.exr", "scene.glb"};
      arguments.insert(arguments.end(), verb.begin() + 1, verb.end());
      const Ended ended = run(arguments);
      EXPECT_EQ(ended.code, 0) << ended.err;
      const std::string said = "scene.glb: nothing of it shows in the picture: ";
      EXPECT_NE(ended.err.find(said), std::string::npos) << verb[0] << ": " << ended.err;
      EXPECT_EQ(ended.err.find(said), ended.err.rfind(said)) << verb[0] << " says it twice: " << ended.err;
      EXPECT_NE(ended.err.find(why), std::string::npos) << verb[0] << ": " << ended.err;
    }
    EXPECT_EQ(run({"compare", "opaque.exr", "out.exr", "--metadata", "ignore"}).code, 0);
  }
  std::string folder;
};

TEST_F(NothingDrawn, AllOpaque) {
  expectSaid({pane(-3, "OPAQUE")}, "none of the 1 materials that its meshes use is transparent");
}
TEST_F(NothingDrawn, NoMesh) {
  expectSaid({}, "it holds no mesh that is drawn");
}
TEST_F(NothingDrawn, BehindTheEye) {
  expectSaid({pane(3)}, "behind the eye");
}
TEST_F(NothingDrawn, BehindTheWall) {
  expectSaid({pane(-500)}, "500 m away or more, and the farthest depth is 10 m");
}
TEST_F(NothingDrawn, BesideThePicture) {
  expectSaid({pane(-3, "BLEND", 60)}, "outside the picture");
}

// Deep samples without light and opacity, as renderers write them where a thing was only just missed.
TEST_F(NothingDrawn, DeepSamplesOfNothing) {
  DeepHeader header;
  header.display = header.data = {0, 0, 16, 16};
  header.channels = {"A", "B", "G", "R", "Z"};
  DeepWriter writer(folder + "/deep.exr", header);
  DeepRows rows;
  rows.window = header.data;
  rows.channels.assign(5, std::vector<float>(16 * 16, 0.0f));
  rows.channels[4].assign(16 * 16, 3.0f);
  for (std::uint64_t i = 0; i <= 16 * 16; ++i) rows.offsets.push_back(i);
  writer.write(rows);
  writer.finish();
  const Ended ended = run({"composite", "opaque.exr", "deep.exr", "-o", "out.exr"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("deep.exr: nothing of it shows in the picture: no deep sample"), std::string::npos)
      << ended.err;
}

TEST_F(NothingDrawn, WhatShowsIsNotMentioned) {
  writeGlb(folder + "/scene.glb", {pane(-3)});
  const Ended ended = run({"composite", "opaque.exr", "scene.glb", "-o", "out.exr"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err.find("nothing of it"), std::string::npos) << ended.err;
}

TEST_F(NothingDrawn, OneCameraInTwoFilesIsOne) {
  writeGlb(folder + "/a.glb", {pane(-3)});
  writeGlb(folder + "/b.glb", {pane(-5)});
  writeGlb(folder + "/both.glb", {pane(-3), pane(-5)});
  for (const char* method : {"over", "phenomenological"}) {
    EXPECT_EQ(run({"composite", "opaque.exr", "both.glb", "-o", "one.exr", "--method", method}).code, 0);
    const Ended two = run({"composite", "opaque.exr", "a.glb", "b.glb", "-o", "two.exr", "--method", method});
    EXPECT_EQ(two.code, 0) << two.err;
    const Ended same = run({"compare", "one.exr", "two.exr"});
    EXPECT_EQ(same.code, 0) << same.out;
  }
  EXPECT_EQ(run({"composite", "opaque.exr", "a.glb", "b.glb", "-o", "named.exr", "--camera", "cam"}).code, 0);
}

}  // namespace
}  // namespace pellucid
