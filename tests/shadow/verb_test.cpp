// --shadows as a user meets it: a pane's shadow on a lit picture, with and without the light's own layer.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

// A wall 4 m away, lit by a sun from behind the camera, and a pane at 2 m of which the sun throws the shadow: shifted
// to the right, so that part of it lies beside the pane.
class Shadow : public ::testing::Test {
 protected:
  static constexpr int kSize = 64;
  static constexpr int kColumn = 52, kRow = 32;  // inside the shadow, which covers columns 48 to 57, rows 24 to 39

  void SetUp() override {
    folder = freshFolder(std::string("shadow-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    writeGlass("glass.glb", true);
  }

  void writeGlass(const std::string& name, bool lit) const {
    const nlohmann::json glass{
        {"name", "glass"},
        {"doubleSided", true},
        {"pbrMetallicRoughness", {{"baseColorFactor", {.9, .5, .1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1}}}}}};
    GlbOptions shot;
    if (lit) {
      shot.nodes = {{{"name", "key"},
                     {"rotation", {0, -std::sin(M_PI / 8), 0, std::cos(M_PI / 8)}},  // shines towards (1, 0, -1)
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
      shot.extra = {
          {"extensions",
           {{"KHR_lights_punctual", {{"lights", {{{"type", "directional"}, {"name", "key"}, {"intensity", 683}}}}}}}}};
    }
    shot.extra["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_ior"};
    writeGlb(folder + "/" + name, {Quad{{-1, -.5f, -2}, {.6f, 0, 0}, {0, 1, 0}, glass}}, shot);
  }
  Image<float> plane(float value) const { return Image<float>(kSize, kSize, value); }
  void writeShot(bool withLayer) const {
    std::vector<ExtraLayer> layers{
        {"", {{"R", plane(.6f)}, {"G", plane(.5f)}, {"B", plane(.4f)}, {"A", plane(1)}, {"Z", plane(4)}}}};
    if (withLayer) layers.push_back({"light.key", {{"R", plane(.5f)}, {"G", plane(.4f)}, {"B", plane(.3f)}}});
    writeLayers(folder + "/shot.exr", {0, 0, kSize, kSize}, {0, 0, kSize, kSize}, layers);
  }
  Ended run(const std::vector<std::string>& extra, const std::string& scene = "glass.glb") const {
    std::vector<std::string> arguments{"composite", "shot.exr", scene,           "-o",   "out.exr",
                                       "--aa",      "1",        "--environment", "0,0,0"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return runProgram(arguments, options);
  }
  OpaqueFile out() const { return readOpaque(folder + "/out.exr", {}); }
  static float channel(const OpaqueFile& file, const std::string& name, int x, int y) {
    const ExrChannel* found = file.document.parts[0].find(name);
    EXPECT_NE(found, nullptr) << name;
    return found ? found->at(static_cast<std::size_t>(y * kSize + x)) : -1.0f;
  }
  static bool beside(int x, int y) {  // neither pane nor shadow, nor their edges
    return (x > 20 && x < 47) || x > 58 || y < 14 || y > 49;
  }

  std::string folder;
  RunOptions options;
};

TEST_F(Shadow, DimsTheLightsOwnLayer) {
  writeShot(true);
  const Ended ended = run({"--shadows", "exact"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const OpaqueFile file = out();
  const glm::vec4 dimmed = file.gbuffer.beauty.at(kColumn, kRow);
  EXPECT_NEAR(dimmed.r, .6f - .1f * .5f, 1e-6);  // the pane lets (.9, .5, .1) through
  EXPECT_NEAR(dimmed.g, .5f - .5f * .4f, 1e-6);
  EXPECT_NEAR(dimmed.b, .4f - .9f * .3f, 1e-6);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      if (beside(x, y)) {
        ASSERT_EQ(file.gbuffer.beauty.at(x, y), glm::vec4(.6f, .5f, .4f, 1.0f)) << x << "," << y;
      }
      ASSERT_EQ(channel(file, "light.key.R", x, y), .5f);
    }
}

// Fig. 9's left: a pane that lets half of the light through hides all of it.
TEST_F(Shadow, AsIfCastersWereOpaque) {
  writeShot(true);
  ASSERT_EQ(run({"--shadows", "exact:opaque"}).code, 0);
  const OpaqueFile file = out();
  const glm::vec4 dimmed = file.gbuffer.beauty.at(kColumn, kRow);
  EXPECT_NEAR(dimmed.r, .6f - .5f, 1e-6);
  EXPECT_NEAR(dimmed.b, .4f - .3f, 1e-6);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (beside(x, y)) {
        ASSERT_EQ(file.gbuffer.beauty.at(x, y), glm::vec4(.6f, .5f, .4f, 1.0f)) << x << "," << y;
      }
}

TEST_F(Shadow, MapsDimItAlike) {
  writeShot(true);
  ASSERT_EQ(run({"--shadows", "exact"}).code, 0);
  const Image<glm::vec4> exact = out().gbuffer.beauty;
  for (const std::string form : {"stochastic", "stochastic:corrected"}) {
    const Ended ended = run({"--shadows", form, "--shadow-size", "1024", "--seed", "5"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Image<glm::vec4> mapped = out().gbuffer.beauty;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mapped.at(kColumn, kRow)[c], exact.at(kColumn, kRow)[c], 3e-4) << form;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        if (beside(x, y)) {
          ASSERT_EQ(mapped.at(x, y), exact.at(x, y)) << form << " " << x << "," << y;
        }
  }
}

TEST_F(Shadow, ViewsShowWhatTheMapsHold) {
  writeShot(true);
  const Ended ended = run({"--shadows", "stochastic:naive", "--shadow-size", "128", "--shadow-views", "views.exr"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const ExrDocument document = readExr(folder + "/views.exr");
  const ExrPart& part = document.parts[0];
  EXPECT_EQ(part.data.width(), 128);
  int cast[3] = {}, empty = 0;
  for (int c = 0; c < 3; ++c) {
    const ExrChannel* depth = part.find("key.depth." + std::string(1, "RGB"[c]));
    const ExrChannel* hidden = part.find("key.hidden." + std::string(1, "RGB"[c]));
    ASSERT_TRUE(depth && hidden);
    for (std::size_t i = 0; i < 128 * 128; ++i) {
      if (hidden->at(i) == 0.0f) {
        ++empty;
        EXPECT_EQ(depth->at(i), 1.1f);
      } else {
        cast[c] += depth->at(i) <= 1.0f ? 1 : 0;
        EXPECT_NEAR(hidden->at(i), c == 0 ? .1f : c == 1 ? .5f : .9f, 3e-4);
      }
    }
  }
  EXPECT_GT(empty, 0);
  // A screen door whose density is what the pane hides: .1, .5 and .9.
  EXPECT_NEAR(cast[1] / static_cast<double>(cast[2]), .5 / .9, .02);
  EXPECT_NEAR(cast[0] / static_cast<double>(cast[2]), .1 / .9, .02);
}

TEST_F(Shadow, NamedLayerOfAnotherName) {
  writeShot(true);
  ASSERT_EQ(run({"--shadows", "exact"}).code, 0);
  const glm::vec4 found = out().gbuffer.beauty.at(kColumn, kRow);
  ASSERT_EQ(run({"--shadows", "exact", "--light", "key=light.key"}).code, 0);
  EXPECT_EQ(out().gbuffer.beauty.at(kColumn, kRow), found);
}

TEST_F(Shadow, WithoutLayersItIsALayerAndAppliedOnRequest) {
  writeShot(false);
  const Ended written = run({"--shadows", "exact"});
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_NE(written.err.find("not applied"), std::string::npos) << written.err;
  OpaqueFile file = out();
  EXPECT_EQ(file.gbuffer.beauty.at(kColumn, kRow), glm::vec4(.6f, .5f, .4f, 1.0f));
  EXPECT_NEAR(channel(file, "shadow.R", kColumn, kRow), .9f, 1e-6);
  EXPECT_NEAR(channel(file, "shadow.B", kColumn, kRow), .1f, 1e-6);
  EXPECT_EQ(channel(file, "shadow.B", 30, 30), 1.0f);
  ASSERT_EQ(run({"--shadows", "exact", "--apply-shadows"}).code, 0);
  file = out();
  EXPECT_NEAR(file.gbuffer.beauty.at(kColumn, kRow).b, .04f, 1e-6);
  EXPECT_EQ(file.gbuffer.beauty.at(30, 30), glm::vec4(.6f, .5f, .4f, 1.0f));
}

TEST_F(Shadow, TheLayerComesThroughTwoSteps) {
  writeShot(false);
  const auto accumulate = [&](const std::string& planes, const std::vector<std::string>& more) {
    std::vector<std::string> all{"accumulate", "shot.exr", "glass.glb",     "-o",   planes, "--aa", "1",
                                 "--weight",   "eq5",      "--environment", "0,0,0"};
    all.insert(all.end(), more.begin(), more.end());
    const Ended made = runProgram(all, options);
    EXPECT_EQ(made.code, 0) << made.err;
  };
  accumulate("planes.exr", {"--shadows", "exact"});
  accumulate("without.exr", {});
  const Ended ended = runProgram({"resolve", "shot.exr", "without.exr", "planes.exr", "-o", "two.exr"}, options);
  ASSERT_EQ(ended.code, 0) << ended.err;
  ASSERT_EQ(run({"--shadows", "exact"}).code, 0);
  const OpaqueFile once = out(), twice = readOpaque(folder + "/two.exr", {});
  for (const char* name : {"shadow.R", "shadow.G", "shadow.B"})
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        ASSERT_EQ(channel(twice, name, x, y), channel(once, name, x, y)) << name << " " << x << ", " << y;
  // What two files hide of a light is in neither.
  const Ended both = runProgram({"resolve", "shot.exr", "planes.exr", "planes.exr", "-o", "both.exr"}, options);
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_NE(both.err.find("2 files of planes have a layer `shadow`"), std::string::npos) << both.err;
  EXPECT_EQ(readOpaque(folder + "/both.exr", {}).document.parts[0].find("shadow.R"), nullptr);
}

TEST_F(Shadow, MistakesAreOneSentence) {
  writeShot(true);
  writeGlass("dark.glb", false);
  const auto expect = [&](const std::vector<std::string>& extra, int code, const std::string& says,
                          const std::string& scene = "glass.glb") {
    const Ended ended = run(extra, scene);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
  };
  expect({"--light", "key=light.key"}, 2, "--light: found it without --shadows");
  expect({"--apply-shadows"}, 2, "--apply-shadows: found it without --shadows");
  expect({"--shadows", "exact", "--light", "key"}, 2, "expected GLTFNAME=LAYER");
  expect({"--shadows", "soft"}, 2, "soft");
  expect({"--shadows", "exact", "--shadow-size", "1024"}, 2, "alone draws maps");
  expect({"--shadows", "stochastic", "--shadow-size", "1000"}, 2, "multiple of 128");
  expect({"--shadows", "exact", "--shadow-views", "views.exr"}, 2, "alone draws maps");
  expect({"--shadows", "exact", "--seed", "1"}, 2, "draws no random numbers");
  expect({"--shadows", "exact", "--apply-shadows"}, 2, "found layers of single lights");
  expect({"--shadows", "exact", "--light", "lamp=light.key"}, 4, "no light 'lamp'");
  expect({"--shadows", "exact", "--light", "key=light.rim"}, 4, "no such layer");
  expect({"--shadows", "exact"}, 4, "no punctual light", "dark.glb");
  EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"dark.glb", "glass.glb", "shot.exr"}));
}

// Sun shadows of glass, smoke and leaves on Cycles' opaque render, through its light group.
TEST_F(Shadow, BlenderSceneComesNearerToThePathTracedTruth) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets";
  const std::string blender = assets() + "/blender/";
  const auto composite = [&](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"composite",
                                       blender + "gbuffer.exr",
                                       blender + "transparent_lit.glb",
                                       "-o",
                                       "out.exr",
                                       "--preset",
                                       "blender",
                                       "--aa",
                                       "1"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    ReadOptions read;
    read.preset = "blender";
    return readOpaque(folder + "/out.exr", read).gbuffer.beauty;
  };
  const Image<glm::vec4> plain = composite({});
  const Image<glm::vec4> opaque = [&] {
    ReadOptions read;
    read.preset = "blender";
    return readOpaque(blender + "gbuffer.exr", read).gbuffer.beauty;
  }();
  std::vector<bool> covered(plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) covered[i] = plain[i] != opaque[i];
  // The truth is a picture alone; its colours are all that is read.
  const ExrDocument truth = readExr(blender + "gt_lit.exr");
  const ExrPart& part = truth.parts[0];
  const auto meanError = [&](const Image<glm::vec4>& picture) {
    double sum = 0;
    for (std::size_t i = 0; i < picture.size(); ++i)
      for (int c = 0; c < 3; ++c)
        sum += std::abs(static_cast<double>(picture[i][c]) -
                        static_cast<double>(part.find(std::string(1, "RGB"[c]))->at(i)));
    return sum / (3.0 * static_cast<double>(picture.size()));
  };
  const double before = meanError(plain);
  Image<glm::vec4> exact;
  for (const std::string kind : {"exact", "stochastic"}) {
    const Image<glm::vec4> shadowed = composite({"--shadows", kind, "--light", "key=Combined_key"});
    std::size_t changed = 0, beside = 0;  // beside: a map's tent reaches some texels beyond the shadow
    for (std::size_t i = 0; i < plain.size(); ++i) changed += plain[i] != shadowed[i] ? 1 : 0;
    const double after = meanError(shadowed);
    std::printf("%s: mean error to gt_lit %.4f without shadows, %.4f with; %.1f%% of the pixels changed\n",
                kind.c_str(), before, after, 100.0 * static_cast<double>(changed) / static_cast<double>(plain.size()));
    EXPECT_LT(after, .9 * before);
    EXPECT_LT(changed, plain.size() / 2);  // the sky and the open floor keep their bits
    if (exact.empty()) {
      exact = shadowed;
      continue;
    }
    // Where nothing transparent stands, and on transparent things, which are shaded by the same light.
    double apart = 0, upon = 0, dimmed = 0;
    std::size_t bare = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      bare += covered[i] ? 0 : 1;
      for (int c = 0; c < 3; ++c) {
        (covered[i] ? upon : apart) += std::abs(static_cast<double>(exact[i][c]) - static_cast<double>(shadowed[i][c]));
        if (covered[i]) dimmed += std::abs(static_cast<double>(exact[i][c]) - static_cast<double>(plain[i][c]));
      }
      beside += !covered[i] && plain[i] != shadowed[i] && plain[i] == exact[i] ? 1 : 0;
    }
    apart /= 3.0 * static_cast<double>(bare);
    upon /= 3.0 * static_cast<double>(exact.size() - bare);
    dimmed /= 3.0 * static_cast<double>(exact.size() - bare);
    std::printf(
        "maps against rays: mean difference %.5f on opaque things, %.5f on transparent ones, which the shadows "
        "change by %.5f; %.2f%% of the pixels changed beside the exact shadow\n",
        apart, upon, dimmed, 100.0 * static_cast<double>(beside) / static_cast<double>(bare));
    EXPECT_LT(apart, .1 * (before - after));
    EXPECT_LT(upon, .2 * dimmed);
  }
}

}  // namespace
}  // namespace pellucid
