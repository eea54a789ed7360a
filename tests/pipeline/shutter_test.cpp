// The shutter that a picture's header names, and the layer that shows what a picture cannot know of its depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "composite/pipeline/compositor.h"
#include "composite/pipeline/resolve_planes.h"
#include "composite/pipeline/study_run.h"
#include "gbuffer/header_time.h"
#include "gbuffer/moved_depth.h"
#include "gbuffer/opaque_io.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

std::size_t differingPixels(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

// A wall, and from x0 on a post before it.
void writePost(const std::string& path, int x0, const std::map<std::string, std::string>& attributes) {
  const auto plane = [&](float value) { return Image<float>(kShotWidth, kShotHeight, value); };
  Image<float> z = plane(20.0f);
  for (int y = 0; y < kShotHeight; ++y)
    for (int x = x0; x < kShotWidth; ++x) z.at(x, y) = 3.0f;
  const Window window{0, 0, kShotWidth, kShotHeight};
  writeLayers(path, window, window,
              {{"", {{"R", plane(0.25f)}, {"G", plane(0.5f)}, {"B", plane(0.75f)}, {"A", plane(1.0f)}, {"Z", z}}}},
              attributes);
}

class HeaderShutter : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-shutter");
    files = writeShotFiles(folder);
  }
  Request request(const std::string& picture) const {
    Request request = requestOf(folder + "/" + picture, files.scene);
    request.passes = 4;
    return request;
  }
  Image<glm::vec4> run(const Request& request) {
    said.clear();
    return Compositor(request, [&](const std::string& note) { said += note + "\n"; }).run(request).picture.rgba;
  }
  ShotFiles files;
  std::string folder, said;
};

TEST_F(HeaderShutter, IsTakenAndCanBeUndone) {
  writePost(folder + "/blurred.exr", kShotWidth, {{"Frame", "12"}, {kShutterAttribute, shutterText({-0.5, 0.25})}});
  writePost(folder + "/sharp.exr", kShotWidth, {{"Frame", "12"}});
  Request sharp = request("sharp.exr"), asked = sharp;
  asked.shutter = Shutter{-0.5, 0.25, false};
  const Image<glm::vec4> blurred = run(asked), plain = run(sharp);
  EXPECT_GT(differingPixels(blurred, plain), 0u);
  Request byHeader = request("blurred.exr");
  EXPECT_EQ(differingPixels(run(byHeader), blurred), 0u);
  EXPECT_NE(said.find("shutter: -0.5:0.25 by attribute pellucid:shutter; --shutter 0:0"), std::string::npos) << said;
  byHeader.shutter = Shutter{0.0, 0.0, false};
  EXPECT_EQ(differingPixels(run(byHeader), plain), 0u);
  // One pass has one time, and a scene that stands still needs none.
  byHeader.shutter.reset();
  byHeader.passes = sharp.passes = 1;
  EXPECT_EQ(differingPixels(run(byHeader), run(sharp)), 0u);
  byHeader.passes = 4;
  byHeader.shot.time.animations = {"none"};
  run(byHeader);
  EXPECT_EQ(said.find("shutter:"), std::string::npos) << said;
}

TEST_F(HeaderShutter, WhatIsMalformedIsAsIfAbsent) {
  writePost(folder + "/sharp.exr", kShotWidth, {{"Frame", "12"}});
  const Image<glm::vec4> plain = run(request("sharp.exr"));
  for (const char* text : {"", "0.5", "0.5:-0.5", "a:b", "-1e9:1e9", "nan:nan", "-0.5:0.5 ", "-0.5:0.5:1"}) {
    writePost(folder + "/odd.exr", kShotWidth, {{"Frame", "12"}, {kShutterAttribute, text}});
    EXPECT_EQ(differingPixels(run(request("odd.exr")), plain), 0u) << text;
  }
}

TEST(ShutterText, ReadsBack) {
  for (const OpenShutter& shutter :
       {OpenShutter{-0.25, 0.25}, OpenShutter{0.0, 1.0 / 3.0}, OpenShutter{-1e-300, 1e4}}) {
    ExrDocument document;
    document.parts.emplace_back();
    document.parts[0].attributes[kShutterAttribute] = {"string", shutterText(shutter)};
    const HeaderTime time = headerTimeOf(document);
    ASSERT_TRUE(time.shutter) << shutterText(shutter);
    EXPECT_EQ(time.shutter->open, shutter.open);
    EXPECT_EQ(time.shutter->close, shutter.close);
  }
}

// As the standard spells it, and as OpenImageIO's writers do.
TEST(HeaderRate, InBothSpellings) {
  for (const char* name : {"framesPerSecond", "FramesPerSecond"}) {
    ExrDocument document;
    document.parts.emplace_back();
    const std::int32_t rate[2] = {30000, 1001};
    document.parts[0].attributes[name] = {"rational", std::string(reinterpret_cast<const char*>(rate), sizeof rate)};
    ASSERT_TRUE(headerTimeOf(document).framesPerSecond) << name;
    EXPECT_NEAR(*headerTimeOf(document).framesPerSecond, 29.97, 0.001) << name;
  }
}

// What gbuffer says of a time that a frame alone does not tell; flags win over it.
TEST(StatedTimes, ReadBackAndGiveWayToFlags) {
  for (const StatedTime& stated : {StatedTime{0.1, 30000.0 / 1001.0}, StatedTime{-1e9, 1e-3}}) {
    ExrDocument document;
    document.parts.emplace_back();
    document.parts[0].attributes[kTimeAttribute] = {"string", timeText(stated)};
    document.parts[0].attributes["Frame"] = {"string", "12"};
    const HeaderTime header = headerTimeOf(document);
    ASSERT_TRUE(header.stated);
    EXPECT_EQ(header.stated->seconds, stated.seconds);
    EXPECT_EQ(header.stated->framesPerSecond, stated.framesPerSecond);
    EXPECT_EQ(momentOf({}, header)->seconds, stated.seconds);
    EXPECT_EQ(momentOf({}, header)->at(1.0), stated.seconds + 1.0 / stated.framesPerSecond);
    ShotTime asked;
    asked.framesPerSecond = 48.0;
    EXPECT_EQ(momentOf(asked, header)->seconds, 0.25);
    asked.frame = 24;
    EXPECT_EQ(momentOf(asked, header)->seconds, 0.5);
  }
  for (const char* text : {"", "1", "1:0", "1:-24", "nan:24", "1:inf", "2e9:24", "1:24 "}) {
    ExrDocument document;
    document.parts.emplace_back();
    document.parts[0].attributes[kTimeAttribute] = {"string", text};
    EXPECT_FALSE(headerTimeOf(document).stated) << text;
  }
}

// What is uncovered beside a post lies where neither the post nor the wall lands.
TEST_F(HeaderShutter, TheLayerUnseenIsTheUncoveredShare) {
  const int x0 = kShotWidth / 2;
  writePost(folder + "/post.exr", x0, {});
  Request lens = request("post.exr");
  lens.lens.radius = 0.5;
  lens.lens.focus = 20.0;
  lens.layers = {LayerName::unseen};
  Compositor compositor(lens);
  const Result result = compositor.run(lens);
  const auto layer = std::find_if(result.layers.begin(), result.layers.end(),
                                  [](const ExtraLayer& each) { return each.name == "unseen"; });
  ASSERT_NE(layer, result.layers.end());
  const Image<float>& share = layer->channels[0].second;
  double wall = 0.0, post = 0.0;
  for (int y = 4; y < kShotHeight - 4; ++y)
    for (int x = 4; x < kShotWidth - 4; ++x) {
      const auto value = static_cast<double>(share.at(x, y));
      EXPECT_EQ(value * 4.0, std::floor(value * 4.0)) << "a share of four passes";
      if (x < x0 - 3 || x > x0 + 3) {
        EXPECT_EQ(value, 0.0) << x << ", " << y;
      }
      (x < x0 ? wall : post) += value;
    }
  // The wall is in focus and stands still; the post goes aside by radius * height * (1/3 - 1/20) at most, and uncovers
  // the wall behind it.
  EXPECT_GT(post, 0.0);
  EXPECT_EQ(wall, 0.0) << "what the post goes over is hidden, not unseen";

  std::vector<PassPlanes> passes;
  Compositor(lens).accumulate(lens, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
  writePasses(folder + "/planes.exr", passes);
  PlanesRequest resolve;
  resolve.opaque = lens.shot.opaque;
  resolve.planes = {folder + "/planes.exr"};
  resolve.layers = {LayerName::unseen};
  Journal journal;
  const ResolvedPlanes resolved = resolvePlanes(resolve, journal);
  EXPECT_EQ(differingPixels(resolved.picture.rgba, result.picture.rgba), 0u);
  const Image<float>& again = resolved.layers.at(0).channels[0].second;
  for (std::size_t i = 0; i < share.size(); ++i) ASSERT_EQ(again[i], share[i]);

  lens.lens = LensRequest();
  const Result still = compositor.run(lens);
  const Image<float>& none = still.layers.at(0).channels[0].second;
  for (std::size_t i = 0; i < none.size(); ++i) ASSERT_EQ(none[i], 0.0f) << "nothing moves the picture";
}

// A study's truth is blurred as its rows are; a row of one pass shows what sharp layers cost.
TEST_F(HeaderShutter, AStudyIsOfTheBlurredPicture) {
  Request base = requestOf(files.flat, files.scene);
  openShutter(base);
  openLens(base);
  base.passes = 4;
  const std::vector<StudyCandidate> candidates = studyCandidates(
      base, {"weighted"}, {1, 4}, {Tier::float32}, [](const std::string& name, int) { return paintOf(name); });
  ASSERT_EQ(candidates.size(), 4u);
  for (const StudyCandidate& candidate : candidates) {
    EXPECT_EQ(candidate.request.shutter.has_value(), candidate.request.passes == 4);
    EXPECT_EQ(candidate.request.lens.on(), candidate.request.passes == 4);
  }
  Compositor compositor(base);
  const StudyOutcome outcome = runStudy(compositor, candidates, 1);
  Request truth = base;
  truth.method = "over";
  truth.paint = paintOf("over");
  const Image<glm::vec4> picture = compositor.run(truth).picture.rgba;
  for (std::size_t k = 0; k < outcome.rows.size(); ++k) {
    const bool isTruth = outcome.rows[k].method == "over" && outcome.rows[k].samples == 4;
    EXPECT_EQ(outcome.rows[k].error.rmse == 0.0, isTruth) << outcome.rows[k].method << outcome.rows[k].samples;
    if (!isTruth) continue;
    for (std::size_t i = 0; i < picture.size(); ++i) ASSERT_EQ(glm::vec3(picture[i]), outcome.pictures[k][i]);
  }
  const Ended refused =
      runProgram({"study", files.flat, files.scene, "-o", folder + "/study", "--shutter", "-0.5:0.5", "--frame", "12"});
  EXPECT_EQ(refused.code, 2) << "one pass has one time";
  EXPECT_NE(refused.err.find("--shutter: found a time with --aa 1"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace pellucid
