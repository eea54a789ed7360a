#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/render_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/study_files.h"
#include "composite/cli/verbs.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

struct StudyFlags {
  std::string folder;
  std::vector<std::string> methods{"phenomenological", "sum",        "average",   "blended",   "weighted",
                                   "unsorted",         "front+tail", "wavelet:2", "moments:4", "mlab:4"};
  RenderFlags render;
  RunFlags run;
  std::vector<int> passes{1};
  std::vector<std::string> precisions{"float"};
  int repeats = 3;
};

Paint paintOf(const std::string& name, int passes, const StochasticFlags& flags) {
  if (name == "phenomenological") return PaintSums{};
  if (name == "over") return PaintSorted{};
  if (const auto variant = stochasticVariant(name)) return PaintSamples{flags.settings(*variant, passes), false};
  if (const auto chosen = chooseMethod(name)) return PaintListed{*chosen};
  throw UsageError(fmt::format("--methods: found '{}', expected over, phenomenological, {}, {}", name, kStochasticNames,
                               methodNames()));
}

void study(const StudyFlags& flags) {
  const Threads threads(flags.run.threads);
  Request base = flags.render.request();
  base.passes = *std::max_element(flags.passes.begin(), flags.passes.end());
  std::vector<Tier> tiers;
  for (const std::string& precision : flags.precisions) tiers.push_back(tierOf(precision));
  const std::vector<StudyCandidate> candidates = studyCandidates(
      base, flags.methods, flags.passes, tiers,
      [&](const std::string& name, int passes) { return paintOf(name, passes, flags.render.stochastic); });
  Compositor compositor(base, [](const std::string& note) { say(note); });
  std::error_code error;
  std::filesystem::create_directories(flags.folder, error);
  if (error) throw ResourceError(fmt::format("{}: cannot be made: {}", flags.folder, error.message()));
  const StudyOutcome outcome = runStudy(compositor, candidates, base, flags.repeats);
  writeStudy(flags.folder, flags.render.opaque, outcome);
  if (flags.run.json)
    fmt::print("{}\n", jsonOf(outcome.rows).dump(2));
  else
    fmt::print("{}\n\n{}", outcome.machine, studyText(outcome.rows));
}

}  // namespace

void addStudy(CLI::App& app) {
  auto flags = std::make_shared<StudyFlags>();
  CLI::App* verb = app.add_subcommand(
      "study", "Time of the exact picture of a shot, and error against time of the other methods: table, plot, page");
  RenderVerb what;
  what.precision = false;
  what.passes = false;
  flags->render.addTo(*verb, what);
  verb->add_option("-o,--output", flags->folder, "Folder for study.txt, .csv, .json, .svg, .png and .html")->required();
  verb->add_option("--methods", flags->methods,
                   fmt::format("Methods to compare with over, which is the truth: phenomenological, {}, {}",
                               kStochasticNames, methodNames()))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  verb->add_option("--aa", flags->passes,
                   "Jittered passes, averaged: numbers to compare; the truth is over at the most of them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb->add_option("--precision", flags->precisions, "Tiers of phenomenological to compare: float, exact, published")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"float", "exact", "published"}))
      ->capture_default_str();
  verb->add_option("--repeats", flags->repeats,
                   "Timed runs of every row after one that is not counted; the median and its spread are printed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--threads", flags->run.threads, "0 uses every core")->check(CLI::NonNegativeNumber);
  verb->add_flag("--json", flags->run.json, "Print the table as JSON");
  verb->callback([flags] { study(*flags); });
}

}  // namespace pellucid::cli
