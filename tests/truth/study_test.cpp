// The study's table, plot and page, and the fitted weight against every listed one.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "composite/over.h"
#include "composite/study/fit_weight.h"
#include "composite/study/study.h"
#include "gbuffer/accum.h"
#include "tests/support/exr_shots.h"
#include "tests/support/layers.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"
#include "tests/truth/sets.h"

namespace pellucid {
namespace {

using namespace test;

TEST(WeightAuto, NoListedWeightIsMoreThanTwoPercentBetter) {
  for (std::size_t s = 0; s < 5; ++s) {
    const char set = "ABCDE"[s];
    const FragmentLists all = listsOfSet(set, 8000, s % 2 == 1, 500 + s);
    GBuffer gbuffer;
    gbuffer.display = gbuffer.data = all.window;
    gbuffer.beauty = Image<glm::vec4>(all.window.width(), 1, glm::vec4(.5f));
    Veil truth(all.window.width(), 1);
    compositeSorted(all, all.window, truth);
    WeightProbes probes(gbuffer, 2000);
    probes.add(all);
    const shading::WeightSettings given = weightOf(shading::PLD_WEIGHT_EQ5);
    const WeightFit fit = fitWeight(probes, given, shading::PLD_NORMALISE_SPECTRAL);
    EXPECT_GT(fit.probes, 1000u);
    EXPECT_LT(fit.probes, 8000u);
    const auto errorOf = [&](const shading::WeightSettings& weight) {
      Veil veil(all.window.width(), 1);
      compositeBy(*chooseMethod("weighted"), {0, weight, 0}, all, all.window, veil);
      double sum = 0;
      for (std::size_t i = 0; i < veil.light.size(); ++i)
        for (int c = 0; c < 3; ++c)
          sum += std::abs(static_cast<double>(veil.light[i][c] + .5f * veil.transmission[i][c]) -
                          static_cast<double>(truth.light[i][c] + .5f * truth.transmission[i][c]));
      return sum / (3.0 * static_cast<double>(veil.light.size()));
    };
    double best = 1e9;
    for (int kind = shading::PLD_WEIGHT_EQ5; kind <= shading::PLD_WEIGHT_UNIFORM; ++kind)
      best = std::min(best, errorOf(weightOf(kind)));
    const double fitted = errorOf(fit.weight);
    printf("[ figure ] set %c: auto %s, mean error %.5f on all pixels, best listed weight %.5f\n", set,
           weightText(fit.weight).c_str(), fitted, best);
    EXPECT_LE(fitted, best * 1.02) << set;
  }
}

TEST(Study, FrontHoldsWhatNothingBeats) {
  std::vector<StudyRow> rows(4);
  const double seconds[] = {1, 2, 3, 4}, rmse[] = {.4, .5, .1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    rows[i].seconds = seconds[i];
    rows[i].error.rmse = rmse[i];
  }
  markFront(rows);
  EXPECT_TRUE(rows[0].front && !rows[1].front && rows[2].front && rows[3].front);
}

TEST(Study, VerbWritesTablePlotAndPage) {
  const std::string folder = freshFolder("study-verb");
  RunOptions options;
  options.folder = folder;
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", {Quad{{-1, -1, -4}, {2, 0, 1}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
                                   Quad{{-1, -1, -3}, {2, 0, -1}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)},
                                   Quad{{-1, -1, -2.5f}, {2, 0, 0}, {0, 2, 0}, unlit(.1f, .1f, .9f, .4f)}});
  const Ended ended =
      runProgram({"study", "opaque.exr", "glass.glb", "-o", "out", "--json", "--weight", "auto"}, options);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("--weight auto:"), std::string::npos) << ended.err;
  const nlohmann::json rows = nlohmann::json::parse(ended.out);
  ASSERT_EQ(rows.size(), 11u);
  std::map<std::string, double> rmse;
  for (const auto& row : rows) {
    rmse[row["method"]] = row["rmse"].get<double>();
    EXPECT_GT(row["seconds"].get<double>(), 0.0);
  }
  EXPECT_EQ(rmse["over"], 0.0);
  EXPECT_LT(rmse["mlab:4"], 1e-6);  // three layers fit
  EXPECT_LT(rmse["front+tail"], rmse["blended"]);
  EXPECT_GT(rmse["sum"], rmse["blended"]);
  EXPECT_EQ(filesIn(folder + "/out"),
            (std::vector<std::string>{"study.csv", "study.html", "study.json", "study.svg", "study.txt"}));
  EXPECT_EQ(nlohmann::json::parse(slurp(folder + "/out/study.json")), rows);
  EXPECT_NE(slurp(folder + "/out/study.svg").find("wavelet:2"), std::string::npos);
  EXPECT_EQ(runProgram({"study", "opaque.exr", "glass.glb", "-o", "out", "--methods", "moments:5"}, options).code, 2);
}

}  // namespace
}  // namespace pellucid
