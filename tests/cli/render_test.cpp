// `render`: a glTF and nothing else, and cameras that frame it.
#include <gtest/gtest.h>

#include "gbuffer/opaque_io.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

nlohmann::json opaque(float r, float g, float b) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}}}};
}

class Render : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder =
        freshFolder(std::string("render-") + testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  // A wall, a red pane before it, and a sun.
  void writeScene(bool camera) {
    GlbOptions scene;
    scene.camera = camera;
    const nlohmann::json sun{{"type", "directional"}, {"intensity", 1366}, {"name", "sun"}};
    scene.nodes = {{{"name", "sun"},
                    {"rotation", {-0.3826834, 0, 0, 0.9238795}},
                    {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    scene.extra = {{"extensions", {{"KHR_lights_punctual", {{"lights", {sun}}}}}}};
    writeGlb(options.folder + "/scene.glb",
             {Quad{{-2, -2, -4}, {4, 0, 0}, {0, 4, 0}, opaque(.8f, .7f, .6f)},
              Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .5f)}},
             scene);
  }
  Ended run(const std::vector<std::string>& arguments) { return runProgram(arguments, options); }
  Image<glm::vec4> beauty(const std::string& name) {
    return readOpaque(options.folder + "/" + name, {}).gbuffer.beauty;
  }
  RunOptions options;
};

TEST_F(Render, IsGbufferAndComposite) {
  writeScene(true);
  ASSERT_EQ(run({"render", "scene.glb", "-o", "one.exr", "--size", "48x32", "--samples", "4"}).code, 0);
  ASSERT_EQ(run({"gbuffer", "scene.glb", "-o", "opaque.exr", "--size", "48x32", "--samples", "4", "--environment",
                 "0.5,0.5,0.5"})
                .code,
            0);
  ASSERT_EQ(run({"composite", "opaque.exr", "scene.glb", "-o", "two.exr", "--environment", "0.5,0.5,0.5", "--shadows",
                 "exact"})
                .code,
            0);
  const Image<glm::vec4> one = beauty("one.exr"), two = beauty("two.exr"), before = beauty("opaque.exr");
  std::size_t changed = 0;
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i], two[i]) << i;
    changed += one[i] != before[i];
  }
  EXPECT_GT(changed, one.size() / 20) << "the pane and its shadow";
  EXPECT_LT(changed, one.size());
}

TEST_F(Render, FramesASceneWithoutACameraAndLeavesNothingBeside) {
  writeScene(false);
  const Ended ended = run({"render", "scene.glb", "-o", "out.exr", "--size", "48x32", "--samples", "1", "--aa", "1",
                           "--preview", "out.png", "--fog", "density=0.01,shafts=0"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("--camera fit:30,20, which frames the scene"), std::string::npos) << ended.err;
  EXPECT_EQ(filesIn(options.folder), (std::vector<std::string>{"out.exr", "out.png", "scene.glb"}));
  const OpaqueFile file = readOpaque(options.folder + "/out.exr", {});
  ASSERT_TRUE(file.gbuffer.camera);
  for (const glm::dvec3 corner : {glm::dvec3(-2, -2, -4), {2, -2, -4}, {2, 2, -4}, {-2, 2, -4}, {.5, .5, -3}}) {
    const Projected at = project(*file.gbuffer.camera, file.gbuffer.display, corner);
    EXPECT_TRUE(at.pixel.x > 0 && at.pixel.x < 48 && at.pixel.y > 0 && at.pixel.y < 32)
        << at.pixel.x << " " << at.pixel.y;
  }
}

TEST_F(Render, WithoutLightsAndOpaqueThingsItShowsTheSurroundings) {
  writeGlb(options.folder + "/scene.glb", {Quad{{-.5f, -.5f, -3}, {1, 0, 0}, {0, 1, 0}, unlit(1, 0, 0, .5f)}});
  ASSERT_EQ(run({"render", "scene.glb", "-o", "out.exr", "--size", "32x32", "--environment", "0.2,0.4,0.6"}).code, 0);
  const Image<glm::vec4> picture = beauty("out.exr");
  EXPECT_NEAR(picture.at(0, 0).r, .2, 1e-6);  // the mean of 16 samples of it rounds
  EXPECT_NEAR(picture.at(16, 16).r, .6, 1e-6);
  EXPECT_NEAR(picture.at(16, 16).b, .3, 1e-6);
}

TEST_F(Render, CamerasThatFit) {
  writeScene(false);
  const auto shown = [&](const std::string& camera) {
    const Ended ended =
        run({"gbuffer", "scene.glb", "-o", "g.exr", "--size", "16x16", "--samples", "1", "--camera", camera});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return readOpaque(options.folder + "/g.exr", {}).gbuffer.camera->viewFromWorld;
  };
  EXPECT_EQ(shown("fit"), shown("fit:30,20"));
  EXPECT_NE(shown("fit"), shown("fit:-30,20"));
  writeOpaque(options.folder + "/opaque.exr");
  EXPECT_EQ(run({"composite", "opaque.exr", "scene.glb", "-o", "o.exr", "--camera", "fit:0,0", "--aa", "1"}).code, 0);
}

TEST_F(Render, WhatIsRefused) {
  writeScene(false);
  writeOpaque(options.folder + "/opaque.exr");
  struct Row {
    std::vector<std::string> words;
    int code;
    const char* sentence;
  };
  const Row rows[] = {
      {{"gbuffer", "scene.glb", "-o", "g.exr", "--size", "8x8"}, 4, "--camera fit, which frames the scene"},
      {{"composite", "opaque.exr", "scene.glb", "-o", "o.exr"}, 4, "such as --camera 'eye="},
      {{"render", "scene.glb", "-o", "o.exr", "--camera", "fit:10"}, 2, "--camera: found '10', expected fit:AZIMUTH"},
      {{"render", "scene.glb", "-o", "o.exr", "--camera", "fit:10,95"}, 2, "expected degrees from -90 to 90"},
      {{"render", "scene.glb", "-o", "o.exr", "--camera", "none"}, 2, "none"},
      {{"render", "scene.glb", "-o", "o.png"}, 2, ".exr"},
      {{"render", "scene.glb", "-o", "scene.glb"}, 2, "scene.glb"},
      {{"render", "missing.glb", "-o", "o.exr"}, 3, "missing.glb"},
      {{"render", "scene.glb", "-o", "o.exr", "--size", "8"}, 2, "--size: found '8'"},
      {{"render", "scene.glb", "-o", "o.exr", "--fog", "density=-1"}, 2, "--fog"},
  };
  for (const Row& row : rows) {
    const Ended ended = run(row.words);
    EXPECT_EQ(ended.code, row.code) << ended.err;
    EXPECT_NE(ended.err.find(row.sentence), std::string::npos) << ended.err << "\n  lacks " << row.sentence;
  }
  EXPECT_EQ(filesIn(options.folder), (std::vector<std::string>{"opaque.exr", "scene.glb"}));
}

// The scene's own camera is another one: that of the first step is meant all the same.
TEST_F(Render, TakesTheCameraThatItIsGiven) {
  writeScene(true);
  for (const std::string camera : {"eye=0.5,0,1;look=0,0,-5;up=0,1,0;fov=50", "fit", "cam"}) {
    const Ended one =
        run({"render", "scene.glb", "-o", "one.exr", "--size", "48x32", "--samples", "4", "--camera", camera});
    ASSERT_EQ(one.code, 0) << camera << ": " << one.err;
    ASSERT_EQ(run({"gbuffer", "scene.glb", "-o", "opaque.exr", "--size", "48x32", "--samples", "4", "--environment",
                   "0.5,0.5,0.5", "--camera", camera})
                  .code,
              0);
    ASSERT_EQ(run({"composite", "opaque.exr", "scene.glb", "-o", "two.exr", "--environment", "0.5,0.5,0.5", "--shadows",
                   "exact", "--camera", "picture"})
                  .code,
              0);
    const Image<glm::vec4> got = beauty("one.exr"), want = beauty("two.exr"), before = beauty("opaque.exr");
    ASSERT_EQ(got.size(), want.size());
    std::size_t changed = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_EQ(got[i], want[i]) << camera << " " << i;
      changed += got[i] != before[i];
    }
    EXPECT_GT(changed, 20u) << camera;
  }
}

}  // namespace
}  // namespace pellucid
