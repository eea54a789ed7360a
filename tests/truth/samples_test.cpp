// What is promised of every sample and of the exact case: the fitted weight, the stated tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "composite/deep/deep_source.h"
#include "composite/error.h"
#include "composite/methods/method.h"
#include "composite/over.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/layers.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

class Shots : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    name = GetParam();
    folder = freshFolder(std::string("shots-") + name + "-" +
                         ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name()[0]);
    opaque = folder + "/" + name + ".exr";
    glass = folder + "/" + name + ".glb";
    if (name == "real") {
      if (assets().empty()) GTEST_SKIP() << "no shared assets";
      opaque = assets() + "/blender/flat_gbuffer_center.exr";
      glass = assets() + "/blender/transparent_unlit.glb";
    } else {
      RunOptions generator;
      generator.program = "pellucid_samples";
      ASSERT_EQ(runProgram({folder, name, "180"}, generator).code, 0);
    }
  }
  nlohmann::json measured(std::vector<std::string> flags, const std::string& passes = "1") {
    flags.insert(flags.begin(), {"composite", opaque, glass, "-o", folder + "/out.exr", "--aa", passes, "--measure",
                                 "--stats", "--json"});
    const Ended ended = runProgram(flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  }
  // Mean error of weighted over the lists of the whole shot, beside the truth of the same lists.
  double meanErrorOf(const FragmentLists& lists, const Veil& truth, const shading::WeightSettings& weight) {
    Veil veil(lists.window.width(), lists.window.height());
    compositeBy(*chooseMethod("weighted"), {0, weight, shading::PLD_NORMALISE_SPECTRAL}, lists, lists.window, veil);
    double sum = 0;
    for (std::size_t i = 0; i < veil.light.size(); ++i) {
      const glm::dvec3 d = glm::abs(glm::dvec3(veil.light[i]) - glm::dvec3(truth.light[i]));
      sum += d.r + d.g + d.b;
    }
    return sum / (3.0 * static_cast<double>(veil.light.size()));
  }
  std::string name, folder, opaque, glass;
};

TEST_P(Shots, FittedWeightIsWithinTwoPercentOfTheBestListed) {
  // All at full resolution, as the lists are: what low resolution adds to the error is no weight's.
  const nlohmann::json fitted = measured({"--method", "phenomenological", "--weight", "auto", "--low-res", "1"});
  const double autoMean = fitted["error"]["mean"].get<double>();
  // The same lists in this process: once for all weights.
  ASSERT_EQ(runProgram({"fragments", opaque, glass, "-o", folder + "/deep.exr"}).code, 0);
  const OpaqueFile file = readOpaque(opaque, {});
  const DepthConverter metres({}, PixelType::float32, std::nullopt, 1.0, nullptr, file.gbuffer.display, "deep.exr");
  std::vector<std::unique_ptr<DeepSource>> sources;
  sources.push_back(std::make_unique<DeepSource>(folder + "/deep.exr", metres, file.gbuffer, 0));
  FragmentLists none, lists;
  none.window = file.gbuffer.data;
  none.solid = Image<glm::vec4>(none.window.width(), none.window.height(), glm::vec4(0, 0, 0, INFINITY));
  none.offsets.assign(none.solid.size() + 1, 0);
  mergeDeep(none, sources, file.gbuffer, VolumeRule::midDepth, UINT64_MAX,
            [&](const FragmentLists& all) { lists = all; });
  ASSERT_EQ(lists.window, file.gbuffer.data);
  Veil truth(lists.window.width(), lists.window.height());
  compositeSorted(lists, lists.window, truth);
  const std::pair<const char*, int> kinds[] = {
      {"eq5", shading::PLD_WEIGHT_EQ5},        {"eq7", shading::PLD_WEIGHT_EQ7},   {"eq8", shading::PLD_WEIGHT_EQ8},
      {"eq9", shading::PLD_WEIGHT_EQ9},        {"eq10", shading::PLD_WEIGHT_EQ10}, {"eq7z", shading::PLD_WEIGHT_EQ7Z},
      {"eq8z", shading::PLD_WEIGHT_EQ8Z},      {"eq9z", shading::PLD_WEIGHT_EQ9Z}, {"eq10z", shading::PLD_WEIGHT_EQ10Z},
      {"uniform", shading::PLD_WEIGHT_UNIFORM}};
  double best = 1e9;
  const char* bestName = "";
  for (const auto& [label, kind] : kinds) {
    const double mean = meanErrorOf(lists, truth, weightOf(kind));
    if (mean < best) best = mean, bestName = label;
  }
  std::printf("[ figure ] %s: --weight auto, mean error %.6f; best listed weight %s %.6f\n", name.c_str(), autoMean,
              bestName, best);
  // A picture that errs by less than the rounding of floats cannot be told apart.
  EXPECT_LE(autoMean, best * 1.02 + 1e-7);
}

TEST_P(Shots, ToleranceIsNeverViolated) {
  const double tolerance = .004;
  const nlohmann::json report = measured({"--tolerance", std::to_string(tolerance)}, "2");
  const Image<glm::vec4> within = readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
  const nlohmann::json weighted = measured({"--method", "phenomenological"}, "2");
  const Ended over = runProgram({"composite", opaque, glass, "-o", folder + "/over.exr", "--aa", "2"});
  ASSERT_EQ(over.code, 0) << over.err;
  const Image<glm::vec4> truth = readOpaque(folder + "/over.exr", {}).gbuffer.beauty;
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double x = static_cast<double>(within[i][c]), t = static_cast<double>(truth[i][c]);
      if (std::isfinite(x - t)) worst = std::max(worst, std::abs(x - t) / std::max(1.0, std::abs(t)));
    }
  const auto seconds = [](const nlohmann::json& from, const char* stage) {
    const nlohmann::json& stages = from["statistics"]["seconds"];
    return stages.contains(stage) ? stages[stage].get<double>() : 0.0;
  };
  std::printf(
      "[ figure ] %s: --tolerance .004, worst %.5f, %zu certified, %zu recomputed; %.3f s, over %.3f s, "
      "weighted %.3f s\n",
      name.c_str(), worst, report["tolerance"]["certified"].get<std::size_t>(),
      report["tolerance"]["recomputed"].get<std::size_t>(), seconds(report, "lists and method"),
      seconds(report, "truth: lists and sort"), seconds(weighted, "transparent pass") + seconds(weighted, "resolve"));
  // Pictures of the samples are half floats, which round by up to 2^-11 of the value, in both.
  EXPECT_LE(worst, tolerance + (name == "real" ? 1e-6 : 2 * 0x1p-11));
  EXPECT_LE(report["tolerance"]["measured"].get<double>(), 1);  // before the file rounds
  EXPECT_LE(report["tolerance"]["bound"].get<double>(), 1);
}

INSTANTIATE_TEST_SUITE_P(All, Shots,
                         ::testing::Values("bars", "bottles", "frosted", "ball", "smoke", "foliage", "cad", "chess",
                                           "clouds", "hair", "mixed", "shadows", "shafts", "smokeball", "sparks",
                                           "street", "real"),
                         [](const auto& shot) { return std::string(shot.param); });

}  // namespace
}  // namespace pellucid
