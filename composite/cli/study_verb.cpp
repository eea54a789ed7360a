#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/study_files.h"
#include "composite/cli/study_table.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

Paint paintOf(const std::string& name, int passes, const StochasticFlags& flags) {
  if (name == "phenomenological") return PaintSums{};
  if (name == "over") return PaintSorted{};
  if (const auto variant = stochasticVariant(name))
    return PaintSamples{flags.settings(*variant, passes), flags.sampledOn == "gl"};
  if (const auto chosen = chooseMethod(name)) return PaintListed{*chosen};
  throw UsageError(fmt::format("--methods: found '{}', expected over, phenomenological, {}, {}", name, kStochasticNames,
                               methodNames()));
}

void study(const StudyFlags& flags, FrameRun& frame, const std::shared_ptr<KeptWork>& kept) {
  const Threads threads(flags.run.threads);
  const Request base = flags.base();
  const std::vector<StudyCandidate> candidates = flags.candidates(base);
  flags.checkShown();
  double before = 0.0, part = 0.0;  // of the whole: what is done, and what the method that runs now is
  const auto watch = [&, tell = frame.watcher()](const std::string& stage, double share) {
    tell(stage, before + part * share);
  };
  std::set<std::string> said;  // rows have notes in common
  const auto sayOnce = [&said](const std::string& note) {
    if (said.insert(note).second) say(note);
  };
  Compositor compositor(base, sayOnce, watch, kept);
  makeFolder(flags.folder);
  const auto begins = [&](std::size_t done, std::size_t all) {
    part = 1.0 / static_cast<double>(all);
    before = part * static_cast<double>(done);
  };
  const StudyOutcome outcome = runStudy(compositor, candidates, flags.repeats, begins);
  const OpaqueFile& picture = compositor.shot().opaque;
  flags.write(picture, outcome);
  frame.summary = jsonOf(outcome.rows, picture.space);
  if (flags.run.json)
    fmt::print("{}\n", jsonOf(outcome.rows, picture.space).dump(2));
  else
    fmt::print("{}\n\n{}", outcome.machine, studyText(outcome.rows));
}

}  // namespace

void StudyFlags::addTo(CLI::App& verb) {
  RenderVerb what;
  what.precision = false;
  what.passes = false;
  what.blurs = true;
  render.addTo(verb, what);
  verb.add_option("-o,--output", folder, "Folder for study.txt, .csv, .json, .svg, .png and .html")->required();
  verb.add_option("--methods", methods,
                  fmt::format("Methods to compare with over, which is the truth: phenomenological, {}, {}",
                              kStochasticNames, methodNames()))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  verb.add_option("--aa", passes,
                  "Jittered passes, averaged: numbers to compare; the truth is over at the most of them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb.add_option("--precision", precisions,
                  "Tiers of phenomenological to compare: float, exact, published; others have the first that they take")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"float", "exact", "published"}))
      ->capture_default_str();
  verb.add_option("--repeats", repeats,
                  "Timed runs of every row after one that is not counted; the median and its spread are printed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--threads", run.threads, "0 uses every core")->check(CLI::Range(0, kMostThreads));
  verb.add_flag("--json", run.json, "Print the table as JSON");
  shown.addDisplayTo(verb, "study.html");
}

Request StudyFlags::base() const {
  Request base = render.request();
  base.passes = *std::max_element(passes.begin(), passes.end());
  return base;
}

std::vector<StudyCandidate> StudyFlags::candidates(const Request& base) const {
  render.stochastic.expectRead(methods, "--methods", base.shadows);
  std::vector<Tier> tiers;
  for (const std::string& precision : precisions) tiers.push_back(tierOf(precision));
  return studyCandidates(base, methods, passes, tiers,
                         [&](const std::string& name, int count) { return paintOf(name, count, render.stochastic); });
}

void StudyFlags::checkShown() const {
  const ColourSpace anySpace = *spaceOf(namedSpaces()[0].chromaticities);
  shown.shader(render.scene.colour.request(), render.scene.assetRoot, anySpace);
}

void StudyFlags::write(const OpaqueFile& picture, const StudyOutcome& outcome) const {
  const DisplayShader shader = shown.shader(render.scene.colour.request(), render.scene.assetRoot, picture.space);
  writeStudy(folder, picture, outcome, shader, shown.exposure);
}

void addStudy(CLI::App& app) {
  auto flags = std::make_shared<StudyFlags>();
  auto sequence = std::make_shared<SequenceFlags>();
  CLI::App* verb = app.add_subcommand(
      "study", "Time of the exact picture of a shot, and error against time of the other methods: table, plot, page");
  flags->addTo(*verb);
  sequence->addTo(*verb, {.sideBySide = false, .resumes = false});
  verb->callback([verb, flags, sequence] {
    const auto kept = std::make_shared<KeptWork>(flags->render.scene.device);
    overFrames(*verb, *sequence,
               {flags->run.json, [&](FrameRun& frame) { study(*flags, frame, kept); }, printStudyTable});
  });
}

}  // namespace pellucid::cli
