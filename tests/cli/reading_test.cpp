// What the program makes of other people's files: what it says it understood, units, deep depth and headers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gbuffer/deep_io.h"
#include "gbuffer/exr_document.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class Reading : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder =
        freshFolder(std::string("reading-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  std::string at(const std::string& name) const { return options.folder + "/" + name; }
  // A red pane over the whole picture, so far away.
  void pane(const std::string& name, float metres) {
    writeGlb(at(name), {Quad{{-9, -9, -metres}, {18, 0, 0}, {0, 18, 0}, unlit(1, 0, 0, .5f)}});
  }
  Ended composite(const std::string& opaque, const std::string& scene, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"composite", opaque, scene, "-o", "out.exr", "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  std::size_t changed(float red) {
    const ExrDocument out = readExr(at("out.exr"));
    const ExrChannel* channel = out.parts[0].find("R");
    std::size_t count = 0;
    for (std::size_t i = 0; i < channel->bytes.size() / 4; ++i) count += std::abs(channel->at(i) - red) > 1e-3f;
    return count;
  }
  // One opaque or half transparent sample a pixel, 16 x 16 twice as wide as high, of the camera of writeGlb()'s files.
  //   stored  its depth, from the ray's length over planar depth
  template <class F>
  void deep(const std::string& name, float colour, float alpha, F stored, const std::string& comment = "") {
    Camera camera;
    camera.focal = {1, 2};
    DeepHeader header;
    header.display = header.data = {0, 0, 16, 16};
    header.channels = {"R", "G", "B", "A", "Z"};
    header.camera = &camera;
    header.pixelAspect = 2.0;
    if (!comment.empty()) header.attributes["comment"] = comment;
    DeepRows rows;
    rows.window = header.data;
    rows.offsets = {0};
    rows.channels.resize(5);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const double a = (x + .5) / 8 - 1, b = (1 - (y + .5) / 8) / 2;
        for (std::size_t c = 0; c < 3; ++c) rows.channels[c].push_back(colour);
        rows.channels[3].push_back(alpha);
        rows.channels[4].push_back(static_cast<float>(stored(std::sqrt(1 + a * a + b * b))));
        rows.offsets.push_back(rows.channels[0].size());
      }
    DeepWriter writer(at(name), header);
    writer.write(rows);
    writer.finish();
  }
  RunOptions options;
};

TEST_F(Reading, SaysWhatDepthWasTakenFor) {
  writeOpaque(at("opaque.exr"), {.depth = 7.25f});
  pane("pane.glb", 3);
  const Ended ended = composite("opaque.exr", "pane.glb");
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* words : {"picture: R G B A", "depth: Z, planar depth (planar), 7.25 to 7.25", "1 unit is 1 m"})
    EXPECT_NE(ended.err.find(words), std::string::npos) << words << " in\n" << ended.err;
}

TEST_F(Reading, UnitsOfPictureAndSceneAreApart) {
  OpaqueShot shot;
  shot.depth = 500;
  writeOpaque(at("cm.exr"), shot);
  pane("near.glb", 3);
  pane("far.glb", 8);
  pane("mm.glb", 3000);
  ASSERT_EQ(composite("cm.exr", "near.glb", {"--unit", ".01"}).code, 0);
  EXPECT_EQ(changed(.25f), 64u * 64u);
  ASSERT_EQ(composite("cm.exr", "far.glb", {"--unit", ".01"}).code, 0);
  EXPECT_EQ(changed(.25f), 0u);
  ASSERT_EQ(composite("cm.exr", "far.glb").code, 0);
  EXPECT_EQ(changed(.25f), 64u * 64u) << "500 m are behind 8 m";
  ASSERT_EQ(composite("cm.exr", "mm.glb", {"--unit", ".01"}).code, 0);
  EXPECT_EQ(changed(.25f), 0u);
  writeGlb(at("mm.glb"), {Quad{{-9000, -9000, -3000}, {18000, 0, 0}, {0, 18000, 0}, unlit(1, 0, 0, .5f)}});
  ASSERT_EQ(composite("cm.exr", "mm.glb", {"--unit", ".01", "--scene-unit", ".001"}).code, 0);
  EXPECT_EQ(changed(.25f), 64u * 64u);
}

TEST_F(Reading, DeepSamplesHaveTheirDepthKind) {
  deep("wall.exr", .2f, 1, [](double ray) { return 3 * ray; });
  pane("behind.glb", 3.2f);
  ASSERT_EQ(composite("wall.exr", "behind.glb", {"--depth-kind", "ray"}).code, 0);
  EXPECT_EQ(changed(.2f), 0u);
  ASSERT_EQ(composite("wall.exr", "behind.glb").code, 0);
  EXPECT_GT(changed(.2f), 0u) << "planar depth of the corners is farther";
  deep("near.exr", .4f, .5f, [](double ray) { return 2.9 * ray; });
  ASSERT_EQ(composite("wall.exr", "near.exr", {"--depth-kind", "ray"}).code, 0);
  EXPECT_EQ(changed(.2f), 256u);
  EXPECT_EQ(composite("wall.exr", "near.exr", {"--depth-kind", "auto"}).code, 2);
}

TEST_F(Reading, SaysWhatDeepDepthWasTakenFor) {
  pane("before.glb", 1.5f);
  pane("behind.glb", 8);
  const auto expectWords = [&](const std::string& scene, std::size_t shown, std::vector<const char*> words) {
    const Ended ended = composite("wall.exr", scene);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(changed(.2f), shown) << scene;
    for (const char* each : words) EXPECT_NE(ended.err.find(each), std::string::npos) << each << " in\n" << ended.err;
  };
  deep("wall.exr", .2f, 1, [](double) { return 4.5; });
  expectWords("before.glb", 256, {"depth: Z, planar depth (planar), 4.5 to 4.5, 1 unit is 1 m"});
  // Without a word of --depth-kind, as of flat pictures.
  deep("wall.exr", .2f, 1, [](double) { return -4.5; });
  expectWords("before.glb", 256, {"is negative, -4.5 to -4.5", "(negative), -4.5 to -4.5"});
  expectWords("behind.glb", 0, {"is negative"});
  deep("wall.exr", .2f, 1, [](double) { return 0.5; });
  expectWords("behind.glb", 0, {"lies within 0 to 1, 0.5 to 0.5", "--depth-kind normalised:NEAR:FAR"});
  deep("wall.exr", .2f, 1, [](double) { return -4.5; });
  EXPECT_NE(runProgram({"flatten", "wall.exr", "-o", "flat.exr"}, options).err.find("negative depth"),
            std::string::npos);
}

TEST_F(Reading, SamplesAtInfinityAreFar) {
  deep("sky.exr", .4f, 1, [](double) { return std::numeric_limits<double>::infinity(); });
  deep("near.exr", .1f, .5f, [](double) { return 1.0; });
  const Ended ended = runProgram({"flatten", "near.exr", "sky.exr", "-o", "out.exr"}, options);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const ExrDocument flat = readExr(at("out.exr"));
  EXPECT_NEAR(flat.parts[0].find("R")->at(0), .1f + .5f * .4f, 1e-6);
  EXPECT_EQ(flat.parts[0].find("A")->at(0), 1.0f);
  ASSERT_EQ(runProgram({"flatten", "sky.exr", "-o", "out.exr"}, options).code, 0);
  EXPECT_TRUE(std::isinf(readExr(at("out.exr")).parts[0].find("Z")->at(0)));
}

TEST_F(Reading, FlatPicturesOfDeepOnesKeepTheHeader) {
  deep(
      "deep.exr", .2f, 1, [](double) { return 3.0; }, "shot 12");
  pane("pane.glb", 1);
  ASSERT_EQ(runProgram({"flatten", "deep.exr", "-o", "flat.exr"}, options).code, 0);
  ASSERT_EQ(composite("deep.exr", "pane.glb").code, 0);
  const ExrDocument from = readExr(at("deep.exr"));
  for (const char* name : {"flat.exr", "out.exr"}) {
    const ExrDocument to = readExr(at(name));
    EXPECT_EQ(to.parts[0].text("comment"), "shot 12") << name;
    EXPECT_EQ(to.parts[0].pixelAspect, 2.0) << name;
    for (const char* attribute : {"worldToCamera", "worldToNDC"})
      EXPECT_EQ(to.parts[0].attributes.at(attribute), from.parts[0].attributes.at(attribute)) << name;
    EXPECT_FALSE(to.parts[0].deep);
  }
}

}  // namespace
}  // namespace pellucid
