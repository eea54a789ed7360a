// Routes that mean the same give the same picture: a deep picture of one sample a pixel is the flat one, layers at low
// resolution that are even are those of full resolution, the exact tier knows no order, `study` measures what
// `composite` draws.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/pipeline/study_run.h"
#include "gbuffer/errors.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class Equivalence : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder("pipeline-equivalence");
    files = writeShotFiles(folder);
  }
  ShotFiles files;
  std::string folder;
};

Image<glm::vec4> pictureOf(const Request& request) {
  Compositor compositor(request);
  return compositor.run(request).picture.rgba;
}

double largestGap(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    for (int c = 0; c < 4; ++c)
      largest = std::max(largest, std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c])));
  return largest;
}

void askFog(Request& request) {
  request.fog.text = FogText();
  request.fog.text->medium.density = 0.05;
  request.fog.text->hasDensity = true;
}

const char* const kEveryMethod[] = {"phenomenological", "weighted", "blended",   "over",       "sum",
                                    "average",          "listing3", "mlab:4",    "front+tail", "wavelet:2",
                                    "moments:4",        "unsorted", "stochastic"};

TEST_F(Equivalence, ADeepPictureOfOneSampleIsTheFlatOne) {
  for (const bool fog : {false, true})
    for (const Tier tier : {Tier::float32, Tier::exact})
      for (const char* method : kEveryMethod) {
        if (tier == Tier::exact && std::string(method) == "unsorted") continue;
        Request flat = requestOf(files.flat, files.scene), deep = requestOf(files.deepWall, files.scene);
        for (Request* request : {&flat, &deep}) {
          request->method = method;
          request->paint = paintOf(method);
          request->tier = tier;
          if (fog) askFog(*request);
        }
        SCOPED_TRACE(std::string(method) + (fog ? ", fog" : "") + (tier == Tier::exact ? ", exact" : ""));
        // Floats: a veil of shares against one of a pixel, each rounded once or twice.
        EXPECT_LE(largestGap(pictureOf(flat), pictureOf(deep)), 4e-6);
      }
}

// Systems of one layer each, coarsely sorted, are the sorted truth: over a deep picture sample by sample.
TEST_F(Equivalence, SystemsOverADeepPictureAreHeldOutBySamples) {
  std::vector<std::string> cards;
  for (const float z : {-3.0f, -4.5f, -9.0f, -30.0f}) {
    cards.push_back(folder + "/card" + std::to_string(cards.size()) + ".glb");
    writeGlb(cards.back(), {Quad{{-40, -40, z}, {80, 0, 0}, {0, 80, 0}, unlit(0.9f, 0.2f, -0.02f * z, 0.4f)}});
  }
  for (const bool fog : {false, true})
    for (const std::string& opaque : {files.flat, files.deepWall, files.deepPicture}) {
      Request sorted = requestOf(opaque, cards[0]);
      sorted.shot.inputs = cards;
      sorted.paint = PaintSorted{};
      if (fog) askFog(sorted);
      Request systems = sorted;
      systems.paint = PaintSystems{SystemRule::file, std::nullopt};
      SCOPED_TRACE(opaque + (fog ? ", fog" : ""));
      EXPECT_LE(largestGap(pictureOf(sorted), pictureOf(systems)), 4e-6);
    }
}

TEST_F(Equivalence, FogOverADeepPictureIsHeldOutBySamples) {
  // Without glass: half of each left pixel sees the post at 5 m through that much fog, the other half the wall at 20.
  writeGlb(folder + "/far.glb", {Quad{{-1, -1, -90}, {2, 0, 0}, {0, 2, 0}, unlit(1, 1, 1, 0.5f)}});
  Request request = requestOf(files.deepPicture, folder + "/far.glb");
  request.paint = PaintSorted{};
  request.shot.surroundings = glm::vec3(0.0f);
  askFog(request);
  request.fog.text->medium.albedo = glm::dvec3(0.0);
  const Image<glm::vec4> picture = pictureOf(request);
  const double across = 1.0;  // the middle pixels look along the axis but for 1%
  const double post = 0.2 * std::exp(-0.05 * 5.0 * across), wall = 0.25 * std::exp(-0.05 * 20.0 * across);
  EXPECT_NEAR(picture.at(kShotWidth / 2 - 1, kShotHeight / 2).r, post + 0.5 * wall, 2e-3);
  EXPECT_NEAR(picture.at(kShotWidth / 2, kShotHeight / 2).r, wall, 2e-3);
}

TEST_F(Equivalence, EvenLayersAtLowResolutionAreThoseOfFullResolution) {
  for (const Tier tier : {Tier::float32, Tier::exact, Tier::published})
    for (const char* method : kEveryMethod) {
      Request full = requestOf(files.flat, files.unlitScene);
      full.method = method;
      full.paint = paintOf(method);
      full.tier = tier;
      try {
        validate(full);
      } catch (const UsageError&) {
        continue;
      }
      Request low = full;
      low.shot.scene.overrides = {"material_0.lowResolution=true"};
      SCOPED_TRACE(std::string(method) + ", tier " + std::to_string(static_cast<int>(tier)));
      // 8 bits of published: a step of each of its planes.
      EXPECT_LE(largestGap(pictureOf(full), pictureOf(low)), tier == Tier::published ? 8e-3 : 2e-6);
    }
}

TEST_F(Equivalence, TheExactTierKnowsNoOrder) {
  for (const char* method : {"phenomenological", "sum", "average", "listing3", "front+tail", "mlab:4", "wavelet:2"}) {
    Image<glm::vec4> first;
    for (const std::uint64_t seed : {0u, 3u, 7u}) {
      Request request = requestOf(files.flat, files.scene);
      request.method = method;
      request.paint = paintOf(method);
      request.tier = Tier::exact;
      if (seed) request.residency.order = {SubmissionOrder::shuffle, seed};
      const Image<glm::vec4> picture = pictureOf(request);
      if (first.empty()) first = picture;
      EXPECT_EQ(largestGap(first, picture), 0.0) << method << ", order " << seed;
    }
  }
}

TEST_F(Equivalence, ATolerancesInTheExactTierKnowsNoOrder) {
  Image<glm::vec4> first;
  for (const std::uint64_t seed : {0u, 5u}) {
    Request request = requestOf(files.flat, files.scene);
    request.paint = PaintWithin{0.05};
    request.tier = Tier::exact;
    if (seed) request.residency.order = {SubmissionOrder::shuffle, seed};
    const Image<glm::vec4> picture = pictureOf(request);
    if (first.empty()) first = picture;
    EXPECT_EQ(largestGap(first, picture), 0.0);
  }
}

TEST_F(Equivalence, AdaptiveSamplesOfTheDeviceAreThoseOfLists) {
  Request lists = requestOf(files.flat, files.scene);
  PaintSamples samples;
  samples.settings.samples = 8;
  samples.settings.adaptive = 0.02;
  lists.method = "stochastic";
  lists.paint = samples;
  Request device = lists;
  samples.onDevice = true;
  device.paint = samples;
  // Sums of the device are whole steps of a grid; a lone layer takes a few more sets there, which changes no value.
  EXPECT_LE(largestGap(pictureOf(lists), pictureOf(device)), 2e-4);
}

TEST_F(Equivalence, StudyMeasuresWhatCompositeDraws) {
  for (const bool deep : {false, true}) {
    Request base = requestOf(deep ? files.deepPicture : files.flat, files.scene);
    base.shadows.source = ShadowSource::rays;
    askFog(base);
    Compositor compositor(base);
    const auto candidates = studyCandidates(base, {"phenomenological", "weighted", "average", "stochastic", "mlab:4"},
                                            {1}, {Tier::float32, Tier::exact, Tier::published},
                                            [](const std::string& method, int) { return paintOf(method); });
    const StudyOutcome outcome = runStudy(compositor, candidates, 1);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      Request request = candidates[i].request;
      request.measure = true;
      Compositor alone(request);
      const Result result = alone.run(request);
      ASSERT_TRUE(result.error.has_value());
      EXPECT_EQ(outcome.rows[i].error.mean, result.error->mean)
          << candidates[i].name << " " << candidates[i].precision << (deep ? ", deep" : "");
    }
  }
}

}  // namespace
}  // namespace pellucid
