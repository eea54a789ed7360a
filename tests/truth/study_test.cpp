// The study's table, plot and page, and the fitted weight against every listed one.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "composite/methods/method.h"
#include "composite/over.h"
#include "composite/study/fit_weight.h"
#include "composite/study/plot.h"
#include "composite/study/study.h"
#include "gbuffer/accum.h"
#include "shaders/weights.h"
#include "tests/support/exr_shots.h"
#include "tests/support/layers.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"
#include "tests/truth/browser.h"
#include "tests/truth/sets.h"

namespace pellucid {
namespace {

using namespace test;

TEST(WeightAuto, NoListedWeightIsMoreThanTwoPercentBetter) {
  for (std::size_t s = 0; s < 5; ++s) {
    const char set = "ABCDE"[s];
    const FragmentLists all = listsOfSet(set, 8000, s % 2 == 1, 500 + s);
    const shading::WeightSettings given = weightOf(shading::PLD_WEIGHT_EQ5);
    // Every fourth pixel is a probe.
    FragmentLists some;
    some.window = {0, 0, all.window.width() / 4, 1};
    some.solid = Image<glm::vec4>(some.window.width(), 1, glm::vec4(0, 0, 0, INFINITY));
    some.offsets.assign(1, 0);
    for (std::size_t i = 0; i < some.solid.size(); ++i) {
      for (std::uint64_t k = all.offsets[4 * i]; k < all.offsets[4 * i + 1]; ++k)
        some.fragments.push_back(all.fragments[k]);
      some.offsets.push_back(some.fragments.size());
    }
    const auto errorOver = [](const FragmentLists& lists, const shading::WeightSettings& weight) {
      Veil sorted(lists.window.width(), 1), veil(lists.window.width(), 1);
      compositeSorted(lists, lists.window, sorted);
      compositeBy(*chooseMethod("weighted"), {0, weight, 0}, lists, lists.window, veil);
      double sum = 0;
      for (std::size_t i = 0; i < veil.light.size(); ++i)
        for (int c = 0; c < 3; ++c)
          sum += std::abs(static_cast<double>(veil.light[i][c]) - static_cast<double>(sorted.light[i][c]));
      return sum / (3.0 * static_cast<double>(veil.light.size()));
    };
    const auto onProbes = [&](const shading::WeightSettings& weight) { return errorOver(some, weight); };
    const WeightFit fit = fitWeight(given, depthsOf(some), onProbes, onProbes);
    const auto errorOf = [&](const shading::WeightSettings& weight) { return errorOver(all, weight); };
    double best = 1e9;
    for (int kind = 0; depthWeightOf(kind); ++kind) best = std::min(best, errorOf(weightOf(kind)));
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

// Their column is as long as they are many.
TEST(Study, LabelsOfAnyNumberOfRowsLieInThePlot) {
  const std::string folder = freshFolder("study-labels");
  for (const std::size_t count : {1u, 33u, 34u, 120u})
    for (const double error : {0.0, 0.01}) {
      SCOPED_TRACE(testing::Message() << count << " rows, error " << error);
      std::vector<StudyRow> rows(count);
      for (StudyRow& row : rows) {
        row.method = "a method with a name that is longer than its column is wide";
        row.seconds = 0.02;
        row.error.rmse = error;
      }
      const Plot plot = studyPlot(rows);
      std::vector<double> heights;
      for (const PlotText& text : plot.texts) {
        EXPECT_GT(text.y, 0.0);
        EXPECT_LT(text.y, plot.height);
        if (text.x == PlotLayout::labels) heights.push_back(text.y);
      }
      ASSERT_EQ(heights.size(), count);
      for (std::size_t i = 1; i < count; ++i) EXPECT_GE(heights[i] - heights[i - 1], PlotLayout::textSize - 1e-9);
      writePlotPng(folder + "/plot.png", plot);
      EXPECT_EQ(slurp(folder + "/plot.png").substr(1, 3), "PNG");
    }
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
  for (const auto& row : rows) {
    double stages = 0;
    for (const auto& [name, seconds] : row["stages"].items()) stages += seconds.get<double>();
    EXPECT_NEAR(stages, row["seconds"].get<double>(), 1e-9);
    EXPECT_EQ(row["flip"].get<double>() > 1e-3, row["rmse"].get<double>() > 1e-3) << row["method"];
  }
  EXPECT_EQ(rmse["over"], 0.0);
  EXPECT_LT(rmse["mlab:4"], 1e-6);  // three layers fit
  EXPECT_LT(rmse["front+tail"], rmse["blended"]);
  EXPECT_GT(rmse["sum"], rmse["blended"]);
  EXPECT_EQ(filesIn(folder + "/out"),
            (std::vector<std::string>{"study.csv", "study.html", "study.json", "study.png", "study.svg", "study.txt"}));
  EXPECT_EQ(nlohmann::json::parse(slurp(folder + "/out/study.json")), rows);
  EXPECT_NE(slurp(folder + "/out/study.svg").find("wavelet:2"), std::string::npos);
  EXPECT_EQ(runProgram({"study", "opaque.exr", "glass.glb", "-o", "out", "--methods", "moments:5"}, options).code, 2);
}

TEST(Study, SamplesAndTiersAreRowsOfTheirOwn) {
  const std::string folder = freshFolder("study-rows");
  RunOptions options;
  options.folder = folder;
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", {Quad{{-1, -.7f, -4}, {1.7f, .2f, 1}, {.3f, 1.2f, 0}, unlit(.9f, .2f, .1f, .5f)},
                                   Quad{{-1, -1, -3}, {1.8f, 0, -1}, {.1f, 1.6f, 0}, unlit(.1f, .8f, .3f, .3f)}});
  const Ended ended = runProgram({"study", "opaque.exr", "glass.glb", "-o", "out", "--json", "--aa", "1,4", "--methods",
                                  "phenomenological,listing3", "--precision", "float,exact"},
                                 options);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const nlohmann::json rows = nlohmann::json::parse(ended.out);
  ASSERT_EQ(rows.size(), 8u);
  std::map<std::string, nlohmann::json> by;
  for (const auto& row : rows)
    by[row["method"].get<std::string>() + " " + row["precision"].get<std::string>() + " " +
       std::to_string(row["samples"].get<int>())] = row;
  EXPECT_EQ(by["over double 4"]["rmse"], 0.0);
  EXPECT_GT(by["over double 1"]["rmse"].get<double>(), 1e-3);  // jagged edges against smooth ones
  EXPECT_GT(by["phenomenological float 1"]["rmse"].get<double>(), by["phenomenological float 4"]["rmse"].get<double>());
  EXPECT_NEAR(by["phenomenological exact 4"]["rmse"].get<double>(),
              by["phenomenological float 4"]["rmse"].get<double>(), 1e-5);
  EXPECT_EQ(by["listing3 half 1"]["bitsPerPixel"], 80);
  EXPECT_EQ(runProgram({"study", "opaque.exr", "glass.glb", "-o", "out", "--aa", "0"}, options).code, 2);
}

// A flag belongs to the rows that read it; one that no row reads would do nothing.
TEST(Study, FlagsOfSomeMethods) {
  const std::string folder = freshFolder("study-flags");
  RunOptions options;
  options.folder = folder;
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", {Quad{{-1, -1, -4}, {2, 0, 0}, {0, 2, 0}, unlit(.9f, .2f, .1f, .5f)},
                                   Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, unlit(.1f, .8f, .3f, .3f)}});
  const auto study = [&](const std::string& methods, const std::vector<std::string>& flags) {
    std::vector<std::string> all{"study", "opaque.exr", "glass.glb", "-o", "out", "--json", "--methods", methods};
    all.insert(all.end(), flags.begin(), flags.end());
    return runProgram(all, options);
  };
  const auto errorOf = [&](const std::vector<std::string>& flags) {
    const Ended ended = study("stochastic:basic,weighted", flags);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.code == 0 ? nlohmann::json::parse(ended.out)[1]["rmse"].get<double>() : -1.0;
  };
  const double few = errorOf({"--samples", "4"});
  EXPECT_GT(few, errorOf({"--samples", "256"}));
  EXPECT_NE(few, errorOf({"--samples", "4", "--seed", "5"}));
  errorOf({"--sampled-on", "gl"});
  errorOf({"--weight", "eq7"});
  errorOf({"--precision", "exact"});
  struct Case {
    const char* methods;
    std::vector<std::string> flags;
  };
  for (const Case& each :
       {Case{"weighted,average", {"--samples", "32"}}, Case{"over", {"--seed", "3"}},
        Case{"stochastic:alpha", {"--correction", "off"}}, Case{"average,over", {"--weight", "eq7"}},
        Case{"average", {"--weight-range", "1:20"}}, Case{"mlab:4", {"--normalisation", "published"}},
        Case{"average", {"--self-modulation"}}, Case{"over", {"--resolve", "gl"}},
        Case{"unsorted", {"--precision", "exact"}}, Case{"weighted,over", {"--precision", "float,published"}}}) {
    const Ended ended = study(each.methods, each.flags);
    EXPECT_EQ(ended.code, 2) << each.methods << each.flags[0];
    EXPECT_NE(ended.err.find(each.flags[0] + ":"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find(std::string("--methods ") + each.methods), std::string::npos) << ended.err;
  }
}

TEST(WeightAuto, WhatItPrintsAsksForTheSamePicture) {
  const std::string folder = freshFolder("weight-again");
  RunOptions options;
  options.folder = folder;
  writeOpaque(folder + "/opaque.exr");
  writeGlb(folder + "/glass.glb", {Quad{{-1, -.7f, -4}, {1.7f, .2f, 1}, {.3f, 1.2f, 0}, unlit(.9f, .2f, .1f, .5f)},
                                   Quad{{-1, -1, -3}, {1.8f, 0, -1}, {.1f, 1.6f, 0}, unlit(.1f, .8f, .3f, .3f)}});
  const Ended fitted = runProgram(
      {"composite", "opaque.exr", "glass.glb", "-o", "a.exr", "--method", "phenomenological", "--weight", "auto"},
      options);
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  const std::string key = "the same again: ";
  ASSERT_NE(fitted.err.find(key), std::string::npos) << fitted.err;
  std::istringstream flags(fitted.err.substr(fitted.err.find(key) + key.size()));
  std::vector<std::string> arguments{"composite", "opaque.exr", "glass.glb",       "-o",
                                     "b.exr",     "--method",   "phenomenological"};
  std::string line;
  std::getline(flags, line);
  std::istringstream words(line);
  for (std::string word; words >> word;) arguments.push_back(word);
  ASSERT_EQ(runProgram(arguments, options).code, 0) << line;
  const Ended same =
      runProgram({"compare", "a.exr", "b.exr", "--fail", "0", "--warn", "0", "--metadata", "ignore"}, options);
  EXPECT_EQ(same.code, 0) << same.out << same.err;
}

// The page of a study, on three samples and the real case: the slider moves, and what the canvas shows are the numbers.
class StudyPage : public ::testing::TestWithParam<const char*> {};

TEST_P(StudyPage, SliderMovesAndNumbersAreRead) {
  const std::string name = GetParam(), folder = freshFolder("study-page-" + name);
  std::string opaque = folder + "/" + name + ".exr", glass = folder + "/" + name + ".glb";
  if (name == "real") {
    if (assets().empty()) GTEST_SKIP() << "no shared assets";
    opaque = assets() + "/blender/flat_gbuffer_center.exr";
    glass = assets() + "/blender/transparent_unlit.glb";
  } else {
    RunOptions generator;
    generator.program = "pellucid_samples";
    ASSERT_EQ(runProgram({folder, name, "180"}, generator).code, 0);
  }
  const Ended ended = runProgram({"study", opaque, glass, "-o", folder + "/out", "--json", "--methods",
                                  "phenomenological,average,unsorted,front+tail,wavelet:3"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const nlohmann::json rows = nlohmann::json::parse(ended.out);
  std::map<std::string, double> rmse;
  for (const auto& row : rows) rmse[row["method"]] = row["rmse"].get<double>();
  std::printf("[ figure ] study of %s: rmse", name.c_str());
  for (const auto& [method, value] : rmse) std::printf("  %s %.4g", method.c_str(), value);
  std::printf("\n");
  EXPECT_LT(rmse["wavelet:3"], rmse["average"]);
  EXPECT_LT(rmse["front+tail"], rmse["average"]);
  if (!haveBrowser()) GTEST_SKIP() << "no chromium (apt package chromium)";
  const nlohmann::json out = probePage(folder, folder + "/out/study.html", R"JS(
  const names = pellucid.data.pictures.map(p => p.name);
  const left = names.indexOf('over'), right = names.indexOf('average');
  set('left', left); set('right', right);
  const a = pellucid.data.pictures[left], b = pellucid.data.pictures[right];
  let worst = 0, squares = 0;
  for (let y = 0; y < a.height; ++y) for (let x = 0; x < a.width; ++x) {
    let most = 0;
    for (let c = 0; c < 3; ++c) {
      const d = Math.abs(pellucid.valueAt(a, x, y, c) - pellucid.valueAt(b, x, y, c));
      most = Math.max(most, d); squares += d * d;
    }
    if (most > worst) { worst = most; out.x = x; out.y = y; }
  }
  out.worst = worst; out.rmse = Math.sqrt(squares / (3 * a.width * a.height));
  const view = find('view'), heat = find('heat');
  // Near enough that a pixel of the picture is several of the canvas.
  const state = pellucid.state, zoom = 8;
  state.zoom = zoom;
  state.x = Math.min(Math.max(out.x - 5, 0), a.width * (1 - 1 / zoom));
  state.y = Math.min(Math.max(out.y - 5, 0), a.height * (1 - 1 / zoom));
  pellucid.draw();
  const k = view.width / a.width * zoom;
  const place = [Math.floor((out.x + 0.5 - state.x) * k), Math.floor((out.y + 0.5 - state.y) * k)];
  const values = p => [0, 1, 2].map(c => pellucid.valueAt(p, out.x, out.y, c));
  const brightest = Math.max(...values(a), ...values(b));
  if (brightest > 1) set('exposure', -Math.ceil(Math.log2(brightest)));
  set('split', 1); out.left = at(view, ...place);
  set('split', 0); out.right = at(view, ...place);
  const exposed = p => values(p).map(v => v * 2 ** state.exposure);
  out.leftValues = exposed(a); out.rightValues = exposed(b);
  set('scale', 0); out.hot = at(heat, ...place);
  out.cells = Array.from(document.querySelectorAll('td')).map(td => td.textContent);
  out.points = document.querySelectorAll('svg circle').length;)JS");
  ASSERT_FALSE(out.contains("error")) << out;
  // Pixels of the page are half floats.
  EXPECT_NEAR(out["rmse"].get<double>(), rmse["average"], 2e-3 * rmse["average"] + 1e-5);
  const auto shown = [](double v) {
    v = std::clamp(v, 0.0, 1.0);
    return v <= .0031308 ? 255 * 12.92 * v : 255 * (1.055 * std::pow(v, 1 / 2.4) - .055);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(out["left"][c].get<double>(), shown(out["leftValues"][c].get<double>()), 1.5);
    EXPECT_NEAR(out["right"][c].get<double>(), shown(out["rightValues"][c].get<double>()), 1.5);
  }
  EXPECT_NE(out["left"], out["right"]);
  EXPECT_NE(out["hot"], nlohmann::json({60, 60, 60}));
  EXPECT_EQ(out["points"].get<std::size_t>(), rows.size());
  EXPECT_NE(std::find(out["cells"].begin(), out["cells"].end(), "wavelet:3"), out["cells"].end());
}

INSTANTIATE_TEST_SUITE_P(Shots, StudyPage, ::testing::Values("bottles", "smoke", "bars", "real"),
                         [](const auto& shot) { return std::string(shot.param); });

}  // namespace
}  // namespace pellucid
