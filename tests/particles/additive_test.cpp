// Fire and sparks: particles of opacity 0 whose light shows, adds up in any order, and hides nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/fold.h"
#include "composite/resolve.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"
#include "tests/gl/builder.h"
#include "tests/particles/points_file.h"
#include "tests/support/program.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kSize = 48;

class Sparks : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("sparks-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    Random random(4);
    for (int i = 0; i < 200; ++i) {
      points.positions.push_back({static_cast<float>(random.between(-1, 1)), static_cast<float>(random.between(-1, 1)),
                                  static_cast<float>(random.between(-5, -3))});
      points.radii.push_back(static_cast<float>(random.between(.05, .3)));
    }
    // They reflect nothing: all their light is emission, of 8 in red.
    points.material = {{"name", "sparks"},
                       {"alphaMode", "BLEND"},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, .6}}}},
                       {"emissiveFactor", {1, .5, .25}},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
                       {"extras", {{"pellucid", {{"additive", true}}}}}};
  }
  Ended composite(float background, const std::vector<std::string>& more) const {
    writePoints(folder + "/points.gltf", points);
    const auto plane = [](float value) { return Image<float>(kSize, kSize, value); };
    writeLayers(folder + "/shot.exr", {0, 0, kSize, kSize}, {0, 0, kSize, kSize},
                {{"",
                  {{"R", plane(background)},
                   {"G", plane(background)},
                   {"B", plane(background)},
                   {"A", plane(1)},
                   {"Z", plane(4)}}}});
    RunOptions options;
    options.folder = folder;
    std::vector<std::string> arguments{"composite", "shot.exr", "points.gltf",   "-o",   "out.exr",
                                       "--aa",      "1",        "--environment", "0,0,0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, options);
  }
  Image<glm::vec4> out() const { return readOpaque(folder + "/out.exr", {}).gbuffer.beauty; }

  std::string folder;
  PointsFile points;
};

TEST_F(Sparks, TheirFragmentsHaveLightAndNoOpacity) {
  writePoints(folder + "/points.gltf", points);
  Stage stage(kSize, kSize);
  stage.scene = loadScene({folder + "/points.gltf"}, {});
  std::size_t shining = 0;
  for (const FragmentLists& lists : stage.fragments())
    for (const Fragment& fragment : lists.fragments) {
      ASSERT_EQ(fragment.coverage, 0.0f);
      ASSERT_NEAR(fragment.radiance.g, .5f * fragment.radiance.r, 1e-6f);
      shining += fragment.radiance.r > .1f ? 1 : 0;
    }
  EXPECT_GT(shining, 500u);
}

// Over any background the same light is added, by every method, and alpha stays.
TEST_F(Sparks, LightAddsAndHidesNothing) {
  ASSERT_EQ(composite(0.0f, {}).code, 0);
  const Image<glm::vec4> light = out();
  std::size_t lit = 0;
  for (std::size_t i = 0; i < light.size(); ++i) lit += light[i].r > 1.0f ? 1 : 0;
  EXPECT_GT(lit, 400u);
  EXPECT_LT(lit, light.size());
  for (const char* method : {"phenomenological", "weighted", "over", "stochastic", "moments:4", "mlab:4"}) {
    for (const float background : {.25f, 40.0f}) {
      const Ended ended = composite(background, {"--method", method});
      ASSERT_EQ(ended.code, 0) << ended.err;
      const Image<glm::vec4> shown = out();
      double worst = 0;
      for (std::size_t i = 0; i < light.size(); ++i) {
        if (light[i] == glm::vec4(0, 0, 0, 1)) {
          EXPECT_EQ(shown[i], glm::vec4(background, background, background, 1.0f));
        }
        EXPECT_EQ(shown[i].a, 1.0f);
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst,
                           std::abs(static_cast<double>(shown[i][c]) - static_cast<double>(background + light[i][c])) /
                               static_cast<double>(background + light[i][c]));
      }
      std::printf("%s over %g: off by %.2g\n", method, static_cast<double>(background), worst);
      EXPECT_LT(worst, 2e-6) << method;  // sums of floats in another order
    }
  }
}

// Behind smoke they fade, before it they do not; and what they fade behind is no darker for them.
TEST_F(Sparks, SmokeHidesTheOnesBehindIt) {
  for (const bool behind : {false, true}) {
    points.positions = {{0, 0, behind ? -3.8f : -2.0f}};
    points.radii = {.4f};
    PointsFile smoke;
    smoke.positions = {{0, 0, -3.0f}};
    smoke.radii = {.5f};
    smoke.material = unlitPoints(.1f, .1f, .1f, .9f);
    writePoints(folder + "/smoke.gltf", smoke);
    for (const char* method : {"over", "phenomenological"}) {
      ASSERT_EQ(composite(.25f, {"--method", method}).code, 0);
      const float spark = out().at(kSize / 2, kSize / 2).r - .25f;
      RunOptions options;
      options.folder = folder;
      const std::vector<std::string> common{"-o",
                                            "out.exr",
                                            "--aa",
                                            "1",
                                            "--environment",
                                            "0,0,0",
                                            "--camera",
                                            "eye=0,0,0;look=0,0,-1;fov=53.13010235",
                                            "--method",
                                            method};
      const auto with = [&](std::vector<std::string> files) {
        std::vector<std::string> arguments{"composite", "shot.exr"};
        arguments.insert(arguments.end(), files.begin(), files.end());
        arguments.insert(arguments.end(), common.begin(), common.end());
        const Ended ended = runProgram(arguments, options);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return out().at(kSize / 2, kSize / 2).r;
      };
      const float smokeAlone = with({"smoke.gltf"}), both = with({"smoke.gltf", "points.gltf"});
      const float share = (both - smokeAlone) / spark;
      std::printf("%s, spark %s the smoke: %.4f of its light\n", method, behind ? "behind" : "before",
                  static_cast<double>(share));
      if (std::string(method) == "over") {
        EXPECT_NEAR(share, behind ? .1f : 1.0f, 2e-3f);  // the smoke passes a tenth through its middle
      } else {
        EXPECT_GT(share, behind ? .09f : .5f);
        EXPECT_LT(share, behind ? .6f : 1.0f + 1e-5f);
      }
    }
  }
}

}  // namespace
}  // namespace pellucid::test
