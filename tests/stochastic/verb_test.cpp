// --method stochastic as a user meets it.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class StochasticVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("stochastic-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    OpaqueShot shot;
    shot.width = shot.height = 32;
    writeOpaque(folder + "/opaque.exr", shot);
    writeGlb(folder + "/glass.glb", {Quad{{-1, -1, -4}, {2, 0, 1}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
                                     Quad{{-1, -1, -3}, {2, 0, -1}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)},
                                     Quad{{-.5f, -.2f, -2}, {.6f, 0, 0}, {0, .7f, 0}, unlit(.2f, .2f, 1, 1)}});
  }
  Image<glm::vec4> composite(const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"composite", "opaque.exr", "glass.glb", "-o", "out.exr"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  }
  void refused(const std::vector<std::string>& extra, const std::string& says) {
    std::vector<std::string> arguments{"composite", "opaque.exr", "glass.glb", "-o", "refused.exr"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
  }
  static double meanError(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 3; ++c) sum += std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c]));
    return sum / (3.0 * static_cast<double>(a.size()));
  }
  std::string folder;
  RunOptions options;
};

TEST_F(StochasticVerb, SameSeedSameBitsWhateverTheOrderChunksAndThreads) {
  const auto one = composite({"--method", "stochastic", "--aa", "4", "--seed", "7"});
  const auto other = composite({"--method", "stochastic", "--aa", "4", "--seed", "7", "--order", "shuffle:3",
                                "--budget", "64K", "--threads", "1"});
  const auto noise = composite({"--method", "stochastic", "--aa", "4", "--seed", "8"});
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i], other[i]) << i;
  EXPECT_GT(meanError(one, noise), 1e-4);
}

TEST_F(StochasticVerb, GlDrawsWhatTheCpuSamples) {
  for (const std::string method : {"stochastic:basic", "stochastic:alpha", "stochastic:depth"}) {
    const auto cpu = composite({"--method", method, "--aa", "4", "--seed", "7", "--samples", "16"});
    const auto gl =
        composite({"--method", method, "--aa", "4", "--seed", "7", "--samples", "16", "--sampled-on", "gl"});
    const auto shuffled = composite({"--method", method, "--aa", "4", "--seed", "7", "--samples", "16", "--sampled-on",
                                     "gl", "--order", "shuffle:3", "--budget", "64K", "--threads", "1"});
    double worst = 0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
      ASSERT_EQ(gl[i], shuffled[i]) << i;
      for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(static_cast<double>(cpu[i][c] - gl[i][c])));
    }
    std::printf("%s: gl and cpu at most %.2g apart\n", method.c_str(), worst);
    EXPECT_LT(worst, 1e-4);
  }
}

// Their light is a texture beside the table of masks.
TEST_F(StochasticVerb, GlDrawsParticlesUnderLamps) {
  RunOptions generator = options;
  generator.program = "pellucid_samples";
  ASSERT_EQ(runProgram({".", "sparks", "90"}, generator).code, 0);
  for (const char* noise : {"screen", "object"}) {
    for (const char* where : {"cpu", "gl"}) {
      const Ended ended =
          runProgram({"composite", "sparks.exr", "sparks.glb", "-o", std::string(where) + ".exr", "--method",
                      "stochastic", "--aa", "1", "--samples", "16", "--sampled-on", where, "--noise", noise},
                     options);
      ASSERT_EQ(ended.code, 0) << ended.err;
    }
    const double apart = meanError(readOpaque(folder + "/cpu.exr", {}).gbuffer.beauty,
                                   readOpaque(folder + "/gl.exr", {}).gbuffer.beauty);
    EXPECT_LT(apart, 1e-5) << noise;
  }
}

TEST_F(StochasticVerb, NoiseOnTheObject) {
  const std::vector<std::string> how{"--method", "stochastic:alpha", "--aa", "4", "--seed", "7", "--noise", "object"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), how.begin(), how.end());
    return composite(more);
  };
  const auto one = with({}), other = with({"--order", "shuffle:3", "--budget", "64K", "--threads", "1"}),
             gl = with({"--sampled-on", "gl"});
  const auto screen = composite({"--method", "stochastic:alpha", "--aa", "4", "--seed", "7"});
  const auto truth = composite({"--method", "over", "--aa", "4"});
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i], other[i]) << i;
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(one[i][c], gl[i][c], 1e-4) << i;
  }
  EXPECT_GT(meanError(one, screen), 1e-4) << "other noise";
  std::printf("mean error %.5f on the screen, %.5f on the object\n", meanError(screen, truth), meanError(one, truth));
  EXPECT_LT(meanError(one, truth), 1.3 * meanError(screen, truth)) << "as much of it";
}

// Fog is no object: its noise stays with the pixels, instead of being one mask for all of them.
TEST_F(StochasticVerb, NoiseOfFogBelongsToPixels) {
  const auto foggy = composite(
      {"--method", "stochastic:basic", "--samples", "4", "--aa", "1", "--noise", "object", "--fog", "density=.05"});
  int changes = 0;
  for (int x = 1; x < 32; ++x) changes += foggy.at(x, 0) != foggy.at(x - 1, 0) ? 1 : 0;
  EXPECT_GT(changes, 3) << "one mask for all changes twice at most along a row, where rays are longer";
}

TEST_F(StochasticVerb, EveryVariantTendsToTheTruth) {
  const auto truth = composite({"--method", "over", "--aa", "4"});
  for (const std::vector<std::string>& how : {std::vector<std::string>{"stochastic:basic"},
                                              {"stochastic:alpha"},
                                              {"stochastic:depth"},
                                              {"stochastic:depth", "--correction", "off"},
                                              {"stochastic:basic", "--masks", "naive"}}) {
    std::vector<std::string> arguments{"--aa", "4", "--method"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    std::vector<std::string> few = arguments, many = arguments;
    few.insert(few.end(), {"--samples", "16"});
    many.insert(many.end(), {"--samples", "1024"});
    const double coarse = meanError(composite(few), truth), fine = meanError(composite(many), truth);
    std::printf("%s %s: mean error %.4f at 16 samples, %.4f at 1024\n", how[0].c_str(), how.back().c_str(), coarse,
                fine);
    EXPECT_LT(fine, .35 * coarse) << how[0];  // 64 times the samples: an eighth where naive
  }
}

TEST_F(StochasticVerb, FlagsThatItCannotHonourAreErrors) {
  refused({"--method", "stochastic", "--samples", "9", "--aa", "4"}, "multiple of --aa");
  refused({"--method", "stochastic:basic", "--correction", "on"}, "never corrected");
  refused({"--method", "stochastic:alpha", "--correction", "off"}, "always corrected");
  refused({"--method", "stochastic:fancy"}, "stochastic[:basic|alpha|depth]");
  refused({"--method", "over", "--seed", "3"}, "draws no random numbers");
  refused({"--method", "over", "--noise", "object"}, "draws no random numbers");
  refused({"--method", "over", "--sampled-on", "gl"}, "draws no random numbers");
  refused({"--samples", "8"}, "draws no random numbers");
  refused({"--method", "stochastic", "--weight", "eq7"}, "its layers are not weighed");
  refused({"--method", "stochastic", "--tolerance", ".01"}, "no certificate");
}

}  // namespace
}  // namespace pellucid
