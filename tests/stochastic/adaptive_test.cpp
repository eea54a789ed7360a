// --samples-adaptive: more samples where a pixel is noisy; and materials that refract or diffuse under --sampled-on gl.
#include <gtest/gtest.h>

#include <cmath>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

double worstChannel(glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 apart = glm::abs(a - b);
  return std::max({apart.r, apart.g, apart.b});
}

class Adaptive : public ::testing::Test {
 protected:
  void make(const std::string& sample) {
    folder = freshFolder("adaptive-" + sample);
    options.folder = folder;
    RunOptions generator = options;
    generator.program = "pellucid_samples";
    ASSERT_EQ(runProgram({".", sample, "90"}, generator).code, 0);
    name = sample;
  }
  Image<glm::vec4> composite(const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"composite", name + ".exr", name + ".glb", "-o", "out.exr"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    said = ended.err;
    return readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  }
  double samplesSaid() const {
    const auto at = said.find("samples: ");
    return at == std::string::npos ? 0.0 : std::atof(said.c_str() + at + 9);
  }
  // RMSE over the pixels that transparency touches.
  static double error(const Image<glm::vec4>& a, const Image<glm::vec4>& truth, const Image<glm::vec4>& opaque) {
    double sum = 0, number = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (truth[i] == opaque[i]) continue;
      ++number;
      for (int c = 0; c < 3; ++c) {
        const double scale = std::max(1.0, static_cast<double>(truth[i][c]));
        const double apart = (static_cast<double>(a[i][c]) - static_cast<double>(truth[i][c])) / scale;
        sum += apart * apart / 3.0;
      }
    }
    return std::sqrt(sum / number);
  }
  std::string folder, name, said;
  RunOptions options;
};

TEST_F(Adaptive, KeepsItsErrorForFewerSamples) {
  make("smoke");
  const Image<glm::vec4> opaque = readOpaque(folder + "/smoke.exr", {}).gbuffer.beauty;
  const Image<glm::vec4> truth = composite({"--method", "over", "--aa", "4"});
  double before = 0;
  for (const char* wanted : {"0.02", "0.01", "0.005"}) {
    const Image<glm::vec4> adaptive =
        composite({"--method", "stochastic", "--aa", "4", "--samples", "16", "--samples-adaptive", wanted});
    const double taken = samplesSaid();
    const double found = error(adaptive, truth, opaque);
    const int even = std::max(1, static_cast<int>(std::lround(taken / 4.0))) * 4;
    const double uniform =
        error(composite({"--method", "stochastic", "--aa", "4", "--samples", std::to_string(even)}), truth, opaque);
    std::printf("E = %s: %.0f samples a pixel, error %.5f; as many everywhere %.5f\n", wanted, taken, found, uniform);
    EXPECT_LT(found, std::atof(wanted));
    EXPECT_LT(found, .95 * uniform);
    EXPECT_GE(taken, 16.0);
    EXPECT_GT(taken, before);
    before = taken;
  }
}

TEST_F(Adaptive, SameSeedSameBits) {
  make("bottles");
  const std::vector<std::string> how{"--method", "stochastic:basic",   "--aa", "2",      "--samples",
                                     "8",        "--samples-adaptive", "0.02", "--seed", "5"};
  const Image<glm::vec4> one = composite(how);
  std::vector<std::string> other = how;
  other.insert(other.end(), {"--order", "shuffle:3", "--budget", "1M", "--threads", "1"});
  const Image<glm::vec4> two = composite(other);
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i], two[i]) << i;
}

TEST_F(Adaptive, WhatItCannotHonourIsAnError) {
  make("bottles");
  const auto refused = [&](const std::vector<std::string>& extra, const std::string& says) {
    std::vector<std::string> arguments{"composite", "bottles.exr", "bottles.glb", "-o", "refused.exr"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_NE(ended.err.find(says), std::string::npos) << ended.err;
  };
  refused({"--samples-adaptive", ".01"}, "draws no random numbers");
  refused({"--method", "stochastic", "--samples-adaptive", "0"}, "--samples-adaptive");
}

// Refraction and diffusion are looked up by the same scattering layers.
TEST_F(Adaptive, GlSamplesWhatRefractsAndDiffuses) {
  for (const char* sample : {"ball", "frosted"}) {
    make(sample);
    const std::vector<std::string> how{"--method", "stochastic", "--aa", "2", "--samples", "16", "--seed", "3"};
    std::vector<std::string> onGl = how, plain = how;
    onGl.insert(onGl.end(), {"--sampled-on", "gl"});
    plain.insert(plain.end(), {"--refract", "off", "--diffusion", "off"});
    const Image<glm::vec4> cpu = composite(how), gl = composite(onGl), straight = composite(plain);
    double worst = 0, bent = 0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
      worst = std::max(worst, worstChannel(glm::dvec3(gl[i]), glm::dvec3(cpu[i])));
      bent = std::max(bent, worstChannel(glm::dvec3(straight[i]), glm::dvec3(cpu[i])));
    }
    std::printf("%s: gl and cpu at most %.2g apart; refraction and diffusion change %.2g\n", sample, worst, bent);
    EXPECT_LT(worst, 1e-3);  // a step of a half, which the pictures are, has 5e-4
    EXPECT_GT(bent, .05);
  }
}

}  // namespace
}  // namespace pellucid
