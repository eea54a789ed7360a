// Passes in files of their own: found, held against the picture, and never written into it.
#include "gbuffer/side_files.h"

#include <gtest/gtest.h>

#include <functional>

#include "gbuffer/errors.h"
#include "room.h"

namespace pellucid::test {
namespace {

class SideFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    Part beauty;
    for (const char* name : {"R", "G", "B"}) beauty.planes.push_back(constantPlane(name, exr::HALF, .5f, 48));
    writeFile(at("shot.exr"), {beauty});
  }
  std::string at(const std::string& name) const { return folder.path(name); }
  std::string write(const std::string& name, const std::vector<std::pair<std::string, float>>& channels,
                    const Window& display = {0, 0, 8, 6}) const {
    Part part;
    part.display = display;
    for (const auto& [channel, value] : channels) part.planes.push_back(constantPlane(channel, exr::FLOAT, value, 48));
    writeFile(at(name), {part});
    return at(name);
  }
  OpaqueFile read(const std::string& depth, const std::vector<std::string>& aovs = {}) const {
    ReadOptions options;
    options.depthFile = sideFileOf(depth);
    if (!options.depthFile) options.depthChannel = depth;
    for (const std::string& aov : aovs) options.aovs.push_back(readAov(aov));
    return readOpaque(at("shot.exr"), options);
  }
  std::string refused(const std::function<void()>& work, int code) const {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.exitCode(), code) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }
  TemporaryFolder folder;
};

TEST_F(SideFiles, MapsOfSurroundingsAreNoPasses) {
  const auto expectRefused = [&](int kind, int code, const char* words) {
    Part part;
    part.environmentMap = kind;
    part.planes.push_back(constantPlane("Z", exr::FLOAT, 5.0f, 48));
    writeFile(at("map.exr"), {part});
    EXPECT_NE(refused([&] { read(at("map.exr")); }, code).find(words), std::string::npos);
  };
  expectRefused(0, 4, "attribute envmap: found a lat-long map");
  expectRefused(1, 3, "found a cube map");
}

TEST_F(SideFiles, Names) {
  EXPECT_FALSE(sideFileOf("Z"));
  EXPECT_FALSE(sideFileOf("ViewLayer.Depth.Z"));
  EXPECT_EQ(sideFileOf("a/depth.EXR")->path, "a/depth.EXR");
  EXPECT_EQ(sideFileOf("a/depth.exr:Z.V")->path, "a/depth.exr");
  EXPECT_EQ(sideFileOf("a/depth.exr:Z.V")->channel, "Z.V");
  EXPECT_EQ(readAov("light.key=a=b.exr").path, "a=b.exr");
  for (const char* bad : {"N", "=a.exr", "N=a.png", "sparkle=a.exr", "light.=a.exr"})
    EXPECT_THROW(readAov(bad), UsageError) << bad;
}

TEST_F(SideFiles, DepthByItsNameOrBecauseThereIsNoOther) {
  const std::vector<std::vector<std::pair<std::string, float>>> layouts{
      {{"Z", 7}},
      {{"depth.Z", 7}},
      {{"Y", 7}},
      {{"R", 7}, {"G", 7}, {"B", 7}},
      {{"A", 1}, {"R", 7}, {"G", 7}, {"B", 7}},
      {{"rgba.R", 3}, {"depth.Z", 7}},  // of V-Ray's name one would have to say what it measures
  };
  for (const auto& layout : layouts) {
    const OpaqueFile file = read(write("depth.exr", layout));
    EXPECT_EQ(file.gbuffer.viewZ[0], 7.0f) << layout[0].first;
    EXPECT_EQ(file.choice.depthFile, at("depth.exr"));
    EXPECT_NE(understoodLines(file)[1].find("depth: " + file.choice.depthChannel + " of " + at("depth.exr")),
              std::string::npos);
  }
  EXPECT_EQ(read(write("two.exr", {{"near", 2}, {"far", 9}}) + ":far").gbuffer.viewZ[0], 9.0f);
}

TEST_F(SideFiles, WhatDoesNotFitIsRefused) {
  const std::string colour = refused([&] { read(write("c.exr", {{"R", 1}, {"G", 2}, {"B", 3}})); }, 4);
  EXPECT_NE(colour.find("expected one of them as --depth " + at("c.exr") + ":CHANNEL"), std::string::npos) << colour;
  refused([&] { read(write("two.exr", {{"near", 2}, {"far", 9}})); }, 4);
  refused([&] { read(at("two.exr") + ":middle"); }, 4);
  refused([&] { read(at("absent.exr")); }, 3);
  const std::string size = refused([&] { read(write("large.exr", {{"Z", 2}}, {0, 0, 16, 12})); }, 4);
  EXPECT_NE(size.find("large.exr: --depth: found display window"), std::string::npos) << size;
}

TEST_F(SideFiles, PassesByName) {
  const std::string depth = write("depth.exr", {{"Z", 7}});
  write("n.exr", {{"R", 0}, {"G", 0}, {"B", 1}});
  write("ao.exr", {{"AO", .25f}});
  const OpaqueFile file = read(depth, {"N=" + at("n.exr"), "AO=" + at("ao.exr")});
  ASSERT_FALSE(file.gbuffer.normal.empty());
  EXPECT_EQ(file.gbuffer.normal[0], glm::vec3(0, 0, 1));
  ASSERT_FALSE(file.gbuffer.occlusion.empty());
  EXPECT_EQ(file.gbuffer.occlusion[0], .25f);
}

TEST_F(SideFiles, NothingOfThemIsWritten) {
  const OpaqueFile file = read(write("depth.exr", {{"Z", 7}}), {"N=" + write("n.exr", {{"R", 0}, {"G", 0}, {"B", 1}})});
  Image<glm::vec4> picture(8, 6, glm::vec4(.25f));
  const Image<std::uint8_t> touched(8, 6, 1);
  writePicture(at("out.exr"), file, picture, touched);
  const ExrDocument out = readExr(at("out.exr"));
  ASSERT_EQ(out.parts.size(), 1u);
  EXPECT_EQ(out.parts[0].channels.size(), 3u);
  EXPECT_EQ(out.parts[0].find("R")->at(0), .25f);
}

}  // namespace
}  // namespace pellucid::test
