// Stereo pictures: --view all composites every view with its own camera, as single runs do it.
#include <gtest/gtest.h>

#include <cstring>

#include "gbuffer/camera.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/exr_document.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;
using nlohmann::json;

constexpr int kViewSize = 16;

class Views : public ::testing::Test {
 protected:
  void SetUp() override {
    options.folder =
        freshFolder(std::string("views-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    // A narrow pane, which two cameras see at different places; they stand in the glTF too.
    GlbOptions more;
    more.nodes = json::array({{{"name", "a"}, {"camera", 0}, {"translation", {-.6, 0, 0}}},
                              {{"name", "b"}, {"camera", 0}, {"translation", {.6, 0, 0}}}});
    writeGlb(at("pane.glb"), {Quad{{-.4f, -1, -3}, {.8f, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, .5f)}}, more);
  }
  std::string at(const std::string& name) const { return options.folder + "/" + name; }

  static ExrChannel plane(const std::string& name, float value) {
    ExrChannel channel{name, PixelType::float32, std::vector<std::byte>(kViewSize * kViewSize * sizeof(float))};
    for (std::size_t i = 0; i < kViewSize * kViewSize; ++i)
      std::memcpy(channel.bytes.data() + i * sizeof value, &value, sizeof value);
    return channel;
  }
  static NewExr viewPart(const std::string& view, double eye, bool withCamera, double above = 0.0) {
    NewExr part;
    part.part = "rgba." + view;
    part.display = part.data = {0, 0, kViewSize, kViewSize};
    part.attributes["view"] = view;
    for (const char* name : {"R", "G", "B"}) part.channels.push_back(plane(name, .25f));
    part.channels.push_back(plane("Z", 10));
    if (!withCamera) return part;
    Camera camera;
    camera.focal = {2, 2};
    camera.viewFromWorld[3].x = -eye;
    camera.viewFromWorld[3].y = -above;
    float matrices[2][4][4];
    cameraToExr(camera, matrices[0], matrices[1]);
    part.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
    part.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
    return part;
  }
  void stereo(const std::string& name, bool withCameras) const {
    writeNewExr(at(name), {viewPart("left", -.6, withCameras), viewPart("right", .6, withCameras)});
  }
  Ended composite(const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"composite", "stereo.exr", "pane.glb", "-o", output, "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  // Both views at once are those of single runs.
  void expectTheSame(const std::vector<std::string>& both, const std::vector<std::string>& left,
                     const std::vector<std::string>& right) const {
    ASSERT_EQ(composite("both.exr", both).code, 0);
    ASSERT_EQ(composite("left.exr", left).code, 0);
    ASSERT_EQ(composite("right.exr", right).code, 0);
    const ExrDocument all = readExr(at("both.exr"));
    ASSERT_EQ(all.parts.size(), 2u);
    const ExrDocument one = readExr(at("left.exr")), other = readExr(at("right.exr"));
    for (const ExrChannel& channel : all.parts[0].channels)
      EXPECT_EQ(channel.bytes, one.parts[0].find(channel.name)->bytes) << "left " << channel.name;
    for (const ExrChannel& channel : all.parts[1].channels)
      EXPECT_EQ(channel.bytes, other.parts[1].find(channel.name)->bytes) << "right " << channel.name;
    EXPECT_NE(all.parts[0].find("R")->bytes, all.parts[1].find("R")->bytes) << "they look from elsewhere";
    EXPECT_EQ(one.parts[1].find("R")->at(0), .25f) << "a single run leaves the other view alone";
  }
  // One layer before the picture, of red 0.25 that hides half.
  void deepLayer(const std::string& name, const std::string& view) const {
    DeepHeader header;
    header.display = header.data = {0, 0, kViewSize, kViewSize};
    header.channels = {"R", "G", "B", "A", "Z"};
    if (!view.empty()) header.attributes["view"] = view;
    DeepRows rows;
    rows.window = header.data;
    const std::size_t pixels = kViewSize * kViewSize;
    for (std::size_t i = 0; i <= pixels; ++i) rows.offsets.push_back(i);
    for (const float value : {.25f, 0.0f, 0.0f, .5f, 3.0f}) rows.channels.emplace_back(pixels, value);
    DeepWriter writer(at(name), header);
    writer.write(rows);
    writer.finish();
  }
  int onto(const std::string& picture, const std::string& deep, const std::string& view) const {
    return runProgram({"composite", picture, deep, "-o", "out.exr", "--view", view}, options).code;
  }
  RunOptions options;
};

TEST_F(Views, EachByTheCameraOfItsPart) {
  stereo("stereo.exr", true);
  expectTheSame({"--view", "all", "--layers", "transparent"}, {"--view", "left", "--layers", "transparent"},
                {"--view", "right", "--layers", "transparent"});
}

// An exporter writes the one camera between the eyes, the renderer those of both.
TEST_F(Views, EyesStandBesideTheOneCamera) {
  writeNewExr(at("stereo.exr"), {viewPart("left", -1.5, true), viewPart("right", 1.5, true)});
  writeGlb(at("pane.glb"), {Quad{{-.4f, -1, -3}, {.8f, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, .5f)}}, {});
  expectTheSame({"--view", "all"}, {"--view", "left", "--camera", "picture"},
                {"--view", "right", "--camera", "picture"});
  writeNewExr(at("stereo.exr"), {viewPart("left", -1.5, true, 3), viewPart("right", 1.5, true, 3)});
  EXPECT_EQ(composite("out.exr", {"--view", "all"}).code, 4) << "they stand above it";
}

TEST_F(Views, EachByTheCameraThatIsNamedForIt) {
  stereo("stereo.exr", false);
  expectTheSame({"--view", "all", "--camera", "left=a", "--camera", "right=b"}, {"--view", "left", "--camera", "a"},
                {"--view", "right", "--camera", "right=b"});
}

TEST_F(Views, BothAreReported) {
  stereo("stereo.exr", true);
  const Ended ended = composite("out.exr", {"--view", "all", "--json", "--measure"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const json report = json::parse(ended.out);
  ASSERT_EQ(report["views"].size(), 2u);
  EXPECT_EQ(report["views"][1]["view"], "right");
  EXPECT_TRUE(report["views"][1].contains("error"));
  for (const char* said : {"view left", "view right"}) EXPECT_NE(ended.err.find(said), std::string::npos) << ended.err;
}

// A deep file without views is the same for every eye, and so is a picture without them.
TEST_F(Views, DeepFilesHaveTheirOwn) {
  stereo("stereo.exr", false);
  NewExr picture = viewPart("left", 0, false);
  picture.attributes.erase("view");
  writeNewExr(at("mono.exr"), picture);
  deepLayer("smoke.exr", "");
  deepLayer("left.exr", "left");
  ASSERT_EQ(onto("stereo.exr", "smoke.exr", "right"), 0);
  const ExrDocument right = readExr(at("out.exr"));
  EXPECT_EQ(right.parts[0].find("R")->at(0), .25f);
  EXPECT_EQ(right.parts[1].find("R")->at(0), .375f);
  EXPECT_EQ(onto("stereo.exr", "smoke.exr", "all"), 0);
  EXPECT_EQ(onto("stereo.exr", "left.exr", "left"), 0);
  EXPECT_EQ(onto("stereo.exr", "left.exr", "right"), 4);
  EXPECT_EQ(onto("mono.exr", "left.exr", "left"), 0);
  EXPECT_EQ(onto("mono.exr", "left.exr", "right"), 4);
  EXPECT_EQ(onto("mono.exr", "smoke.exr", "left"), 4) << "nothing has views";
  const auto flatten = [&](const std::string& view) {
    return runProgram({"flatten", "smoke.exr", "left.exr", "-o", "out.exr", "--view", view}, options).code;
  };
  EXPECT_EQ(flatten("left"), 0);
  EXPECT_EQ(flatten("right"), 4);
  const Ended all = runProgram({"composite", "left.exr", "pane.glb", "-o", "out.exr", "--view", "all"}, options);
  EXPECT_EQ(all.code, 2);
  EXPECT_EQ(all.err.find("picture:"), std::string::npos) << all.err;
}

TEST_F(Views, WhatIsRefused) {
  stereo("stereo.exr", true);
  EXPECT_EQ(composite("out.exr", {"--view", "all", "--camera", "middle=a"}).code, 2);
  EXPECT_EQ(composite("out.exr", {"--view", "left", "--camera", "right=a"}).code, 2);
  EXPECT_EQ(composite("out.exr", {"--camera", "a", "--camera", "b"}).code, 2);
  const Ended other = runProgram({"accumulate", "stereo.exr", "pane.glb", "-o", "p.exr", "--view", "all"}, options);
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("composite alone takes all"), std::string::npos) << other.err;
  writeNewExr(at("stereo.exr"), viewPart("left", 0, true));
  EXPECT_EQ(composite("out.exr", {"--view", "all"}).code, 4);
}

}  // namespace
}  // namespace pellucid
