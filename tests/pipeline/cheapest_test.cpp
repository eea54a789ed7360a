// --method auto: the sums where every pixel keeps the tolerance, the truth elsewhere; said, and taken by the next
// frame.
#include "composite/pipeline/cheapest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"
#include "tests/pipeline/shot_files.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

TEST(Choice, FollowsProbesThenEveryPixel) {
  Choice choice;
  choice.tolerance = 0.02;
  choice.layers = 0.5 * kLayersOfSums;
  EXPECT_FALSE(sumsMayDo(choice));
  EXPECT_NE(reasonOf(choice).find("as cheap as sums"), std::string::npos);
  choice.layers = 2.0 * kLayersOfSums;
  choice.onProbes = 1.5;
  EXPECT_FALSE(sumsMayDo(choice));
  EXPECT_NE(reasonOf(choice).find("on probes"), std::string::npos);
  choice.onProbes = 0.5;
  EXPECT_TRUE(sumsMayDo(choice));
  EXPECT_FALSE(sumsDo(choice)) << "nobody has measured";
  choice.measured = 1.001;
  EXPECT_FALSE(sumsDo(choice));
  EXPECT_NE(reasonOf(choice).find("over: "), std::string::npos);
  choice.measured = 1.0;
  EXPECT_TRUE(sumsDo(choice));
  EXPECT_NE(reasonOf(choice).find("phenomenological: "), std::string::npos);
}

class Cheapest : public ::testing::Test {
 protected:
  Cheapest() : folder(freshFolder("cheapest")) {}

  // Cards of smoke that darken with depth, before a wall.
  Request shotOf(int cards, std::uint32_t seed = 5) const {
    Random random(seed);
    const std::string name = folder + "/" + std::to_string(cards) + "-" + std::to_string(seed);
    OpaqueShot wall;
    wall.width = wall.height = 24;
    wall.depth = 9.0f;
    writeOpaque(name + ".exr", wall);
    std::vector<Quad> quads;
    for (int i = 0; i < cards; ++i) {
      const float z = 4.0f + 3.0f * random.uniformf(), light = 1.0f - 0.2f * (z - 4.0f);
      const float x = -3.0f + random.uniformf(), y = -3.0f + random.uniformf();
      quads.push_back({{x, y, -z}, {5, 0, 0}, {0, 5, 0}, unlit(light, light, 0.5f * light, 0.2f)});
    }
    writeGlb(name + ".glb", quads);
    return requestOf(name + ".exr", name + ".glb");
  }
  static Request within(Request request, double tolerance) {
    request.method = "auto";
    request.paint = PaintCheapest{tolerance};
    return request;
  }
  static Request by(Request request, const char* method) {
    request.method = method;
    request.paint = paintOf(method);
    return request;
  }
  static Result drawn(const Request& request) {
    Compositor compositor(request);
    return compositor.run(request);
  }
  std::string folder;
};

bool same(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) return false;
  return true;
}

// Against the truth that another run composites.
double partOf(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth, double tolerance) {
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double t = static_cast<double>(truth[i][c]), off = std::abs(static_cast<double>(picture[i][c]) - t);
      largest = std::max(largest, off / (tolerance * std::max(1.0, std::abs(t))));
    }
  return largest;
}

TEST_F(Cheapest, KeepsEveryToleranceAndTakesTheSumsOnceTheyDo) {
  for (const int passes : {1, 4}) {
    Request shot = shotOf(12);
    shot.passes = passes;
    const Image<glm::vec4> truth = drawn(by(shot, "over")).picture.rgba;
    const Image<glm::vec4> sums = drawn(shot).picture.rgba;
    std::vector<std::string> methods;
    for (const double tolerance : {1e-5, 1e-3, 0.01, 0.05, 0.2, 1.0}) {
      const Result result = drawn(within(shot, tolerance));
      ASSERT_TRUE(result.choice.has_value());
      EXPECT_LE(partOf(result.picture.rgba, truth, tolerance), 1.0) << tolerance;
      const bool tookSums = result.plan.method == "phenomenological";
      EXPECT_EQ(tookSums, partOf(sums, truth, tolerance) <= 1.0) << tolerance;
      EXPECT_TRUE(same(result.picture.rgba, tookSums ? sums : truth)) << tolerance;
      EXPECT_NE(result.plan.methodReason.find(tookSums ? "phenomenological: " : "over: "), std::string::npos);
      methods.push_back(result.plan.method);
    }
    EXPECT_EQ(methods.front(), "over");
    EXPECT_EQ(methods.back(), "phenomenological");
    EXPECT_TRUE(std::is_sorted(methods.begin(), methods.end())) << "a larger tolerance never asks for more";
  }
}

TEST_F(Cheapest, FewLayersAreSorted) {
  const std::string small = folder + "/small.glb";
  writeGlb(small, {Quad{{0, 0, -5}, {0.5f, 0, 0}, {0, 0.5f, 0}, unlit(1, 0, 0, 0.5f)}});
  Request shot = shotOf(1);
  shot.shot.inputs = {small};
  EXPECT_EQ(drawn(within(shot, 1.0)).plan.method, "over");
}

TEST_F(Cheapest, TheNextFrameTakesMethodAndWeight) {
  for (const double tolerance : {1e-5, 1.0}) {
    const Request asked = within(shotOf(12), tolerance);
    Compositor first(asked);
    const Result result = first.run(asked);
    first.write(folder + "/first.exr", result);
    Request next = shotOf(12, 6);
    next.methodFrom = folder + "/first.exr";
    std::string said;
    Compositor second(next, [&](const std::string& note) { said += note + "\n"; });
    const Result taken = second.run(next);
    EXPECT_EQ(taken.plan.method, result.plan.method);
    EXPECT_EQ(said.find("--weight auto"), std::string::npos) << said;
    if (result.plan.method == "phenomenological") {
      EXPECT_EQ(weightText(taken.plan.pass.weight), weightText(result.plan.pass.weight));
    }
    EXPECT_FALSE(taken.choice.has_value());
  }
}

// Whatever a header can say comes back as it was.
TEST_F(Cheapest, EveryMethodGoesFromFileToFile) {
  const Request shot = shotOf(6);
  std::vector<Request> all;
  for (const char* method : {"over", "phenomenological", "weighted", "blended", "average", "sum", "front+tail",
                             "wavelet:3", "moments:6", "mlab:2", "unsorted"})
    all.push_back(by(shot, method));
  all.push_back(shot);
  all.back().paint = PaintWithin{0.03};
  all.push_back(shot);
  all.back().paint = PaintSystems{SystemRule::file, std::nullopt};
  for (const Request& request : all) {
    Compositor first(request);
    const Result result = first.run(request);
    first.write(folder + "/made.exr", result);
    Request again = shot;
    again.methodFrom = folder + "/made.exr";
    const Result taken = drawn(again);
    EXPECT_EQ(taken.plan.method, result.plan.method);
    EXPECT_EQ(taken.plan.paint.index(), result.plan.paint.index()) << result.plan.method;
    EXPECT_TRUE(same(taken.picture.rgba, result.picture.rgba)) << result.plan.method;
  }
}

TEST_F(Cheapest, SaysWhatAHeaderLacks) {
  Request shot = shotOf(2);
  shot.methodFrom = folder + "/none.exr";
  EXPECT_THROW(drawn(shot), InputError);
  shot.methodFrom = shot.shot.opaque;  // no picture of ours
  EXPECT_THROW(drawn(shot), MeaningError);
  Request noisy = by(shotOf(2), "stochastic");
  Compositor compositor(noisy);
  compositor.write(folder + "/noisy.exr", compositor.run(noisy));
  shot.methodFrom = folder + "/noisy.exr";
  EXPECT_THROW(drawn(shot), MeaningError);
}

TEST_F(Cheapest, FlagsThatDoNotGoTogetherAreRefused) {
  const Request shot = shotOf(2);
  const auto codeOf = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments{"composite", shot.shot.opaque, shot.shot.inputs[0], "-o", folder + "/out.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return runProgram(arguments).code;
  };
  EXPECT_EQ(codeOf({"--method", "auto"}), 2);
  EXPECT_EQ(codeOf({"--method", "auto", "--tolerance", ".1", "--systems", "file"}), 2);
  EXPECT_EQ(codeOf({"--method", "auto", "--tolerance", ".1", "--precision", "published"}), 2);
  EXPECT_EQ(codeOf({"--method", "auto", "--tolerance", ".1", "--explain"}), 0);
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--method", "over"},
                                               {"--weight", "eq5"},
                                               {"--weight-from", "x.exr"},
                                               {"--tolerance", ".1"},
                                               {"--systems", "file"}}) {
    std::vector<std::string> flags{"--method-from", shot.shot.opaque};
    flags.insert(flags.end(), more.begin(), more.end());
    EXPECT_EQ(codeOf(flags), 2) << more[0];
  }
  EXPECT_EQ(codeOf({"--method-from", folder + "/none.exr"}), 3);
  EXPECT_EQ(codeOf({"--method-from", shot.shot.opaque}), 4);
}

}  // namespace
}  // namespace pellucid
