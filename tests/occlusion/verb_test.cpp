// `pellucid occlusion` as a user runs it.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/occlusion/plants_scene.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

constexpr float kSkyDepth = std::numeric_limits<float>::infinity();

// A foliage layer and its opaque picture, small and by hand: a leaf from column 10 to 19, its rims at 9 and 20.
struct LeafFiles {
  std::string folder, opaque, layer, out;
  int width = 48, height = 32;
  bool withDepth = true, withAlpha = true, withIndirect = true, withOcclusion = true, half = false, camera = true;
  float layerZ = 2.0f, opaqueZ = 2.0f, skyZ = 9.0f, leafOpen = 0.4f;
  int firstRow = 4, rows = 24;

  explicit LeafFiles(const std::string& name) : folder(freshFolder("occlusion_" + name)) {
    opaque = folder + "/opaque.exr", layer = folder + "/layer.exr", out = folder + "/out.exr";
  }
  bool inRows(int y) const { return y >= firstRow && y < firstRow + rows; }
  float coverage(int x, int y) const {
    if (!inRows(y)) return 0.0f;
    return x >= 10 && x < 20 ? 1.0f : x == 9 || x == 20 ? 0.5f : 0.0f;
  }
  template <class Value>
  Image<float> plane(Value value) const {
    Image<float> image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) image.at(x, y) = value(x, y);
    return image;
  }
  void write() const {
    const Window window{0, 0, width, height};
    const auto leaf = [&](int x, int y) { return coverage(x, y) == 1.0f; };
    Camera pinhole;
    pinhole.focal = {2.0, 3.0};
    std::vector<std::pair<std::string, Image<float>>> picture{
        {"R", plane([](int x, int) { return 0.01f * static_cast<float>(x); })},
        {"G", plane([](int, int) { return 0.2f; })},
        {"B", plane([](int, int) { return 0.3f; })},
        {"Z", plane([&](int x, int y) { return leaf(x, y) ? opaqueZ : skyZ; })}};
    if (withOcclusion) picture.emplace_back("AO", plane([&](int x, int y) { return leaf(x, y) ? leafOpen : 1.0f; }));
    writeLayers(opaque, window, window, {{"", picture}}, {}, camera ? &pinhole : nullptr);

    std::vector<std::pair<std::string, Image<float>>> foliage;
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
      foliage.emplace_back(names[c],
                           plane([&](int x, int y) { return (0.5f + 0.1f * static_cast<float>(c)) * coverage(x, y); }));
    if (withAlpha) foliage.emplace_back("A", plane([&](int x, int y) { return coverage(x, y); }));
    if (withDepth)
      foliage.emplace_back("Z", plane([&](int x, int y) { return coverage(x, y) > 0 ? layerZ : kSkyDepth; }));
    std::vector<ExtraLayer> layers{{"", foliage}};
    if (withIndirect) {
      ExtraLayer indirect{"indirect", {}};
      for (const char* name : names)
        indirect.channels.emplace_back(name, plane([&](int x, int y) { return 0.25f * coverage(x, y); }));
      layers.push_back(indirect);
    }
    writeLayers(layer, window, window, layers, {}, nullptr, half);
  }
  Ended run(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"occlusion", opaque, layer, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }
};

// Every channel of the layer's file against the result's: how many values changed, and none outside the rims.
void expectOnlyRimsChanged(const LeafFiles& files, std::size_t& changed) {
  const ExrDocument before = readExr(files.layer), after = readExr(files.out);
  changed = 0;
  for (const ExrChannel& channel : before.parts[0].channels) {
    const ExrChannel* other = after.parts[0].find(channel.name);
    ASSERT_TRUE(other) << channel.name;
    ASSERT_EQ(other->type, channel.type);
    const std::size_t bytes = bytesOf(channel.type);
    for (int y = 0; y < files.height; ++y)
      for (int x = 0; x < files.width; ++x) {
        const auto i = static_cast<std::size_t>(y * files.width + x);
        const bool same = std::memcmp(channel.bytes.data() + i * bytes, other->bytes.data() + i * bytes, bytes) == 0;
        const float coverage = files.coverage(x, y);
        if (coverage == 0.0f || coverage == 1.0f || channel.name.size() > 1 || channel.name == "A" ||
            channel.name == "Z") {
          EXPECT_TRUE(same) << channel.name << " at " << x << ", " << y;
        }
        changed += !same;
      }
  }
}

float valueOf(const std::string& path, const std::string& channel, int x, int y) {
  const ExrDocument document = readExr(path);
  const ExrChannel* found = document.parts[0].find(channel);
  EXPECT_TRUE(found) << channel;
  return found ? found->at(static_cast<std::size_t>(y * document.parts[0].data.width() + x)) : -1.0f;
}

TEST(OcclusionVerb, DarkensRimsAndNothingElse) {
  for (const bool half : {false, true}) {
    LeafFiles files(half ? "half" : "float");
    files.half = half;
    files.write();
    const Ended ended = files.run();
    ASSERT_EQ(ended.code, 0) << ended.err;
    std::size_t changed = 0;
    expectOnlyRimsChanged(files, changed);
    EXPECT_EQ(changed, 2u * 24u * 3u);
    const float open = valueOf(files.out, "occlusion", 9, 15);
    // All taps along the row but the last two see the leaf.
    EXPECT_NEAR(open, files.leafOpen, 0.03f);
    EXPECT_EQ(valueOf(files.out, "occlusion", 12, 15), 1.0f);
    EXPECT_EQ(valueOf(files.out, "occlusion", 30, 15), 1.0f);
    // Direct light stays: R = 0.25 in all, half of it indirect.
    EXPECT_NEAR(valueOf(files.out, "R", 9, 15), 0.125f + 0.125f * open, half ? 2e-4f : 1e-6f);
  }
}

TEST(OcclusionVerb, DirectShareAndIndirectLayerAreHonoured) {
  LeafFiles files("share");
  files.withIndirect = false;
  files.write();
  Ended ended = files.run();
  EXPECT_EQ(ended.code, 4);
  EXPECT_NE(ended.err.find("indirect"), std::string::npos) << ended.err;
  ended = files.run({"--indirect", "beauty"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const float open = valueOf(files.out, "occlusion", 9, 15);
  EXPECT_NEAR(valueOf(files.out, "R", 9, 15), 0.25f * open, 1e-6f);
  files.withIndirect = true;
  files.write();
  ended = files.run({"--direct", "1"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NEAR(valueOf(files.out, "R", 9, 15), 0.25f * open, 1e-6f);
  EXPECT_EQ(files.run({"--direct", "1.5"}).code, 2);
  EXPECT_EQ(files.run({"--indirect", "nonsense"}).code, 4);
}

TEST(OcclusionVerb, WhatIsMissingIsNamed) {
  const auto codeOf = [](const std::string& name, auto change, const std::string& word) {
    LeafFiles files(name);
    change(files);
    files.write();
    const Ended ended = files.run();
    EXPECT_NE(ended.err.find(word), std::string::npos) << ended.err;
    EXPECT_EQ(filesIn(files.folder).size(), 2u) << "debris";
    return ended.code;
  };
  EXPECT_EQ(codeOf(
                "nodepth", [](LeafFiles& f) { f.withDepth = false; }, "depth"),
            4);
  EXPECT_EQ(codeOf(
                "noalpha", [](LeafFiles& f) { f.withAlpha = false; }, "coverage"),
            4);
  EXPECT_EQ(codeOf(
                "nocamera", [](LeafFiles& f) { f.withOcclusion = f.camera = false; }, "camera"),
            4);
  LeafFiles files("errors");
  files.write();
  ASSERT_EQ(files.run().code, 0);
  const std::string whole = slurp(files.out);
  EXPECT_EQ(runProgram({"occlusion", files.opaque, files.folder + "/none.exr", "-o", files.out}).code, 3);
  EXPECT_EQ(runProgram({"occlusion", files.opaque, files.out, "-o", files.out}).code, 2) << "onto its input";
  EXPECT_EQ(runProgram({"occlusion", files.opaque, files.out, "-o", files.folder + "/twice.exr"}).code, 4)
      << "applied twice";
  EXPECT_EQ(files.run({"--source", "rays"}).code, 2);
  EXPECT_EQ(files.run({"--radius", "-1"}).code, 2);
  EXPECT_EQ(slurp(files.out), whole);
  LeafFiles other("windows");
  other.width = 64;
  other.write();
  EXPECT_EQ(runProgram({"occlusion", files.opaque, other.layer, "-o", other.out}).code, 4);
}

TEST(OcclusionVerb, SkyAloneLeavesTheLayerAsItWas) {
  LeafFiles files("sky");
  files.opaqueZ = files.skyZ = kSkyDepth;
  files.layerZ = kSkyDepth;
  files.write();
  const Ended ended = files.run();
  ASSERT_EQ(ended.code, 0) << ended.err;
  std::size_t changed = 1;
  expectOnlyRimsChanged(files, changed);
  EXPECT_EQ(changed, 0u);
  EXPECT_NE(ended.err.find("48 of 48"), std::string::npos) << ended.err;
  EXPECT_EQ(valueOf(files.out, "occlusion", 9, 15), 1.0f);
}

// One pixel of foliage, wholly a rim, far before a dark background: what lies metres behind says nothing about it.
TEST(OcclusionVerb, OnePixelOfFoliageStaysOpen) {
  LeafFiles files("one");
  files.write();
  const Window window{0, 0, files.width, files.height};
  const auto only = [&](float inside, float outside) {
    return files.plane([=](int x, int y) { return x == 9 && y == 15 ? inside : outside; });
  };
  writeLayers(files.layer, window, window,
              {{"",
                {{"R", only(0.2f, 0)},
                 {"G", only(0.2f, 0)},
                 {"B", only(0.2f, 0)},
                 {"A", only(0.5f, 0)},
                 {"Z", only(2.0f, kSkyDepth)}}}});
  writeLayers(
      files.opaque, window, window,
      {{"", {{"R", only(0, 0)}, {"G", only(0, 0)}, {"B", only(0, 0)}, {"Z", only(50, 50)}, {"AO", only(0.1f, 0.1f)}}}});
  const Ended ended = files.run({"--indirect", "beauty"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const float open = valueOf(files.out, "occlusion", 9, 15);
  printf("[ figure ] one pixel before a wall of occlusion 0.1, 48 m behind: %.4f\n", static_cast<double>(open));
  EXPECT_GT(open, 0.98f);
}

// Leaves that only the layer has: their occlusion comes from the nearer of both depths.
TEST(OcclusionVerb, LeavesThatTheGBufferLacksOccludeFromDepth) {
  LeafFiles files("lacking");
  files.opaqueZ = files.skyZ = 2.4f;  // a wall close behind, without the leaf
  files.leafOpen = 0.0f;              // were this read, rims would be black
  files.write();
  const Ended ended = files.run({"--radius", "1"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("from depth alone"), std::string::npos) << ended.err;
  EXPECT_GT(valueOf(files.out, "occlusion", 9, 15), 0.8f);  // the leaf is flat and nothing stands before it
  EXPECT_EQ(files.run({"--source", "file"}).code, 4);
}

TEST(OcclusionVerb, JsonSaysWhatWasDone) {
  LeafFiles files("json");
  files.write();
  const Ended ended = files.run({"--json", "--threads", "1"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const nlohmann::json report = nlohmann::json::parse(ended.out);
  EXPECT_EQ(report.at("rims"), 48);
  EXPECT_EQ(report.at("changed"), 48);
  EXPECT_NEAR(report.at("meanOcclusion").get<double>(), 0.4, 0.03);
}

TEST(OcclusionVerb, ThreadsChangeNoBit) {
  LeafFiles files("threads");
  files.withOcclusion = false;
  files.write();
  ASSERT_EQ(files.run({"--threads", "1"}).code, 0);
  const std::string one = slurp(files.out);
  ASSERT_EQ(files.run({"--threads", "3"}).code, 0);
  EXPECT_EQ(slurp(files.out), one);
}

// The tree that Blender rendered, against its path-traced picture: with its own AO layer, and without.
TEST(OcclusionVerb, BlendersTreeComesNearerToItsPathTracedPicture) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets";
  const std::string folder = freshFolder("occlusion_blender"), from = assets() + "/blender/";
  const ExrDocument truth = readExr(from + "gt_lit.exr");
  const auto error = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"composite", from + "gbuffer.exr", from + "transparent_lit.glb",
                                       "-o",        folder + "/out.exr",  "--aa",
                                       "2",         "--environment",      "0.21,0.27,0.36"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = runProgram(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const OpaqueFile picture = readOpaque(folder + "/out.exr", {});
    double sum = 0.0;
    for (int y = 60; y < 180; ++y)  // the tree
      for (int x = 430; x < 580; ++x) {
        const glm::vec4 pixel = picture.gbuffer.beauty.at(x, y);
        const auto i = static_cast<std::size_t>(y * picture.gbuffer.data.width() + x);
        const char* names[] = {"R", "G", "B"};
        for (int c = 0; c < 3; ++c)
          sum += static_cast<double>(std::abs(pixel[c] - truth.parts[0].find(names[c])->at(i))) / 3.0;
      }
    return sum / (120.0 * 150.0);
  };
  const double none = error({"--occlusion", "off"}), solid = error({"--occlusion", "solid"}), inferred = error({}),
               fromDepth = error({"--occlusion-source", "screen"});
  printf(
      "[ figure ] Blender's tree against path tracing: mean error %.4f without occlusion, %.4f of solids alone, %.4f "
      "inferred, %.4f inferred without its AO layer\n",
      none, solid, inferred, fromDepth);
  EXPECT_LT(solid, none);
  EXPECT_LT(inferred, solid);
  EXPECT_LT(fromDepth, solid);
}

TEST(OcclusionVerb, FlagsThatOcclusionHasNoUseForAreRefused) {
  const auto refused = [](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments{"composite", "a.exr", "b.glb", "-o", "c.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments);
    EXPECT_EQ(ended.code, 2) << ended.err;
  };
  refused({"--occlusion", "some"});
  refused({"--occlusion-direct", "2"});
  refused({"--occlusion-radius", "0"});
}

}  // namespace
}  // namespace pellucid
