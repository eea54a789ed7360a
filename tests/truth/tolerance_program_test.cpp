// --tolerance as a user meets it: under --aa, with what else a picture may hold, against composite without a method.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gbuffer/opaque_io.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class ToleranceProgram : public ::testing::Test {
 protected:
  static constexpr int kSide = 12;
  static constexpr double kE = .05;

  void SetUp() override {
    options.folder = folder =
        freshFolder(std::string("tolerance-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    writeOpaque(folder + "/opaque.exr", {.width = kSide, .height = kSide, .depth = 50.0f});
  }
  // Stripes half a pixel wide, dark and of `light` in turn: each a front that hides nearly all, and layers behind it
  // whose mean differs by nearly the tolerance of that stripe alone.
  void writeStripes(float light) const {
    std::vector<Quad> quads;
    for (int stripe = 0; stripe < 2 * kSide; ++stripe) {
      const float shown = stripe % 2 ? light : 0.0f,
                  behind = shown + .95f * static_cast<float>(kE) * std::max(1.0f, shown);
      for (int k = 0; k <= 20; ++k) {
        const float z = k == 0 ? 8.0f : 9.0f + .02f * static_cast<float>(k), width = z / (2 * kSide);
        quads.push_back({{-z / 2 + width * static_cast<float>(stripe), -z / 2, -z},
                         {width, 0, 0},
                         {0, z, 0},
                         glowing(k == 0 ? shown : behind, k == 0 ? .999f : .9f)});
      }
    }
    writeGlb(folder + "/stripes.glb", quads);
  }
  static nlohmann::json glowing(float light, float alpha) {
    return {
        {"name", "glow"},
        {"alphaMode", "BLEND"},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0, 0, 0, alpha}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
        {"emissiveFactor", {1, 1, 1}},
        {"extensions",
         {{"KHR_materials_ior", {{"ior", 1.0}}}, {"KHR_materials_emissive_strength", {{"emissiveStrength", light}}}}}};
  }
  Image<glm::vec4> picture(const std::vector<std::string>& flags, nlohmann::json& report) const {
    std::vector<std::string> arguments{"composite", "opaque.exr", "stripes.glb",   "-o",
                                       "out.exr",   "--json",     "--environment", "0,0,0"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    report = nlohmann::json::parse(ended.out, nullptr, false);
    return readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  }
  // The largest error, as a part of what is promised.
  //   flags  of the truth too; more  of the tolerance alone
  double worst(std::vector<std::string> flags, const std::vector<std::string>& more, nlohmann::json& report) const {
    const Image<glm::vec4> truth = picture(flags, report);
    flags.insert(flags.end(), {"--tolerance", std::to_string(kE), "--weight", "uniform", "--measure"});
    flags.insert(flags.end(), more.begin(), more.end());
    const Image<glm::vec4> within = picture(flags, report);
    double largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double x = static_cast<double>(within[i][c]), t = static_cast<double>(truth[i][c]);
        largest = std::max(largest, std::abs(x - t) / (kE * std::max(1.0, std::abs(t))));
      }
    const nlohmann::json& told = report["tolerance"];
    EXPECT_LE(told["bound"].get<double>(), 1);
    EXPECT_NEAR(told["measured"].get<double>(), largest, 1e-3);
    std::printf("[ figure ] %s: worst %.3f of the promise, bound %.3f; %d samples certified, %d exact\n",
                ("--aa " + flags[1] + ", " + flags[2]).c_str(), largest, told["bound"].get<double>(),
                told["certified"].get<int>(), told["recomputed"].get<int>());
    return largest;
  }
  std::string folder;
  RunOptions options;
};

TEST_F(ToleranceProgram, HoldsForTheMeanOfBrightStripes) {
  for (const float light : {1.5f, 1e4f}) {
    writeStripes(light);
    for (const char* passes : {"1", "2", "3", "8", "64"}) {
      nlohmann::json report;
      EXPECT_LE(worst({"--aa", passes}, {}, report), 1) << light << ", --aa " << passes;
      EXPECT_GT(report["tolerance"]["certified"].get<int>(), 0);
    }
  }
}

TEST_F(ToleranceProgram, HoldsWithFogLowResolutionAndTheExactTier) {
  writeStripes(1.5f);
  nlohmann::json report;
  EXPECT_LE(worst({"--aa", "4", "--fog", "density=.02"}, {}, report), 1);
  EXPECT_LE(worst({"--aa", "4", "--set", "glow.lowResolution=true", "--low-res", "2"}, {}, report), 1);
  EXPECT_LE(worst({"--aa", "4"}, {"--precision", "exact", "--order", "shuffle:3"}, report), 1);
}

}  // namespace
}  // namespace pellucid
