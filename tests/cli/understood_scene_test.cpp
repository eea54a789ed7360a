// What is said of a scene in its picture: where it lies, doubts about units, pictures that were composited before, and
// cameras that are not one.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class UnderstoodScene : public ::testing::Test {
 protected:
  void SetUp() override { options.folder = freshFolder("understood-scene"); }
  std::string at(const std::string& name) const { return options.folder + "/" + name; }
  void pane(float metres) const {
    writeGlb(at("pane.glb"), {Quad{{-1, -1, -metres}, {2, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, .5f)}});
  }
  Ended composite(const std::string& opaque, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"composite", opaque, "pane.glb", "-o", "out.exr", "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  static bool says(const Ended& ended, const std::string& words) { return ended.err.find(words) != std::string::npos; }
  // The camera of writeGlb()'s files has a focal length of 2.
  void pictureOf(double focal, glm::dvec2 centre = {0, 0}) const {
    Camera camera;
    camera.focal = {focal, focal};
    camera.centre = centre;
    const auto plane = [](float value) { return Image<float>(16, 16, value); };
    writeLayers(at("own.exr"), {0, 0, 16, 16}, {0, 0, 16, 16},
                {{"", {{"R", plane(.2f)}, {"G", plane(.4f)}, {"B", plane(.6f)}, {"Z", plane(7)}}}}, {}, &camera);
  }
  RunOptions options;
};

TEST_F(UnderstoodScene, WhereItLies) {
  pane(3);
  writeOpaque(at("opaque.exr"), {.depth = 7});
  const Ended before = composite("opaque.exr", {"--json"});
  ASSERT_EQ(before.code, 0) << before.err;
  EXPECT_TRUE(says(before, "scene: (-1, -1, -3) to (1, 1, -3) m, 3 to 3 m away, 100% of it before")) << before.err;
  const nlohmann::json report = nlohmann::json::parse(before.out);
  ASSERT_EQ(report["understood"].size(), 4u) << report;
  EXPECT_EQ(report["understood"][0].get<std::string>().find("picture: "), 0u);
  EXPECT_EQ(report["understood"][1].get<std::string>().find("depth: "), 0u);
  EXPECT_EQ(report["understood"][2].get<std::string>().find("camera: "), 0u);
  EXPECT_EQ(report["understood"][3].get<std::string>().find("scene: "), 0u);
  writeOpaque(at("near.exr"), {.depth = 2.5f});
  EXPECT_TRUE(says(composite("near.exr"), "0% of it before")) << "all of it lies behind";
}

TEST_F(UnderstoodScene, UnitsThatArePowersOfTenApart) {
  pane(3);
  const std::pair<float, const char*> pictures[] = {
      {500, "--unit 0.01"}, {50, "--unit 0.1"}, {4000, "--unit 0.001"}, {0.04f, "--unit 100"}};
  for (const auto& [depth, flag] : pictures) {
    writeOpaque(at("opaque.exr"), {.depth = depth});
    const Ended ended = composite("opaque.exr");
    EXPECT_TRUE(says(ended, flag)) << depth << ": " << ended.err;
  }
  for (const float depth : {2.0f, 3.0f, 7.0f, 12.0f}) {
    writeOpaque(at("opaque.exr"), {.depth = depth});
    EXPECT_FALSE(says(composite("opaque.exr"), "another unit")) << depth;
  }
}

TEST_F(UnderstoodScene, CompositedBefore) {
  pane(3);
  writeOpaque(at("opaque.exr"), {.depth = 7});
  EXPECT_FALSE(says(composite("opaque.exr"), "composited before"));
  std::filesystem::rename(at("out.exr"), at("again.exr"));
  const Ended again = composite("again.exr");
  EXPECT_TRUE(says(again, "the picture was composited before")) << again.err;
}

TEST_F(UnderstoodScene, TwoCamerasThatDisagree) {
  pane(3);
  pictureOf(2.0);
  EXPECT_EQ(composite("own.exr").code, 0) << "one camera twice";
  pictureOf(1.5);
  const Ended apart = composite("own.exr");
  EXPECT_EQ(apart.code, 4);
  for (const char* words : {"focal (1.5, 1.5)", "focal (2, 2)", "attribute worldToCamera", "--camera picture"})
    EXPECT_TRUE(says(apart, words)) << words << " in " << apart.err;
  const Ended files = composite("own.exr", {"--camera", "picture"}), gltf = composite("own.exr", {"--camera", "cam"});
  EXPECT_EQ(files.code, 0) << files.err;
  EXPECT_TRUE(says(files, "camera: attribute worldToCamera")) << files.err;
  EXPECT_EQ(gltf.code, 0) << gltf.err;
  EXPECT_TRUE(says(gltf, "camera: glTF node cam")) << gltf.err;
}

// A glTF has no word for a shifted lens: what differs in it alone is one camera, and the file's is the whole of it.
TEST_F(UnderstoodScene, AShiftedLensIsTheSameCamera) {
  pane(3);
  pictureOf(2.0, {.25, -.125});
  const Ended shifted = composite("own.exr");
  ASSERT_EQ(shifted.code, 0) << shifted.err;
  EXPECT_TRUE(says(shifted, "camera: attribute worldToCamera")) << shifted.err;
  // The pane reaches to 2/3 about the centre: columns (1 + .25 +- 2/3) * 8, and rows (1 + .125 +- 2/3) * 8.
  const Image<glm::vec4> out = readOpaque(at("out.exr"), {}).gbuffer.beauty;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const bool within =
          x + .5 > 10 - 16 / 3.0 && x + .5 < 10 + 16 / 3.0 && y + .5 > 9 - 16 / 3.0 && y + .5 < 9 + 16 / 3.0;
      EXPECT_NEAR(out.at(x, y).r, within ? .6f : .2f, 1e-6f) << x << " " << y;
    }
  pictureOf(1.5, {.25, -.125});
  EXPECT_EQ(composite("own.exr").code, 4) << "another focal length is another camera";
}

}  // namespace
}  // namespace pellucid
