#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/compare_table.h"
#include "composite/cli/number_checks.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"
#include "composite/compare/page.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

const char* wordFor(Verdict verdict) {
  return verdict == Verdict::same ? "same" : verdict == Verdict::warned ? "warning" : "failure";
}

// JSON has no infinity and no NaN: they become their names.
nlohmann::json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

//   flicker  of the frames so far
void compareVerb(const CompareFlags& flags, FrameRun& frame, TemporalError& flicker) {
  const CompareSettings settings = flags.settings();
  flags.check();
  const ExrDocument a = readExr(flags.a), b = readExr(flags.b);
  const CompareReport report = compareExr(a, b, settings);
  if (frame.inSequence()) frame.summary = summaryOf(report, flicker.next(a, b, settings));
  if (flags.json)
    fmt::print("{}\n", jsonOf(report).dump(2));
  else if (!frame.inSequence() || report.verdict != Verdict::same)
    fmt::print("{}", reportText(report, flags.a, flags.b));
  flags.writeHtml(a, b, report);
  if (report.verdict == Verdict::failed) throw Error(1, fmt::format("{} and {} differ", flags.a, flags.b));
}

}  // namespace

nlohmann::json jsonOf(const CompareReport& report) {
  nlohmann::json layers = nlohmann::json::array();
  for (const LayerReport& layer : report.layers) {
    nlohmann::json entry{{"name", layer.name},
                         {"channels", layer.channels},
                         {"verdict", wordFor(layer.verdict)},
                         {"pixels", layer.pixels},
                         {"failing", layer.failing},
                         {"warning", layer.warning},
                         {"notFinite", layer.notFinite},
                         {"notFiniteInBoth", layer.notFiniteInBoth},
                         {"mean", layer.mean},
                         {"rms", layer.rms},
                         {"worst", nullptr}};
    if (layer.worst)
      entry["worst"] = {{"x", layer.worst->x},
                        {"y", layer.worst->y},
                        {"channel", layer.worst->channel},
                        {"a", number(layer.worst->a)},
                        {"b", number(layer.worst->b)},
                        {"difference", number(layer.worst->difference)}};
    layers.push_back(std::move(entry));
  }
  return {{"verdict", wordFor(report.verdict)},
          {"structure", report.structure},
          {"metadata", report.metadata},
          {"layers", layers}};
}

void CompareFlags::addTo(CLI::App& verb) {
  verb.add_option("a", a, "EXR")->required();
  verb.add_option("b", b, "EXR to hold against it")->required();
  CompareSettings& settings = thresholds;
  verb.add_option("--fail", settings.fail.absolute, "Largest difference of a value")
      ->check(notBelowZero())
      ->capture_default_str();
  verb.add_option("--failrelative", settings.fail.relative, "The same, times the larger of the two values")
      ->check(notBelowZero())
      ->capture_default_str();
  verb.add_option("--failpercent", settings.fail.percent, "Pixels of a layer that may exceed it")
      ->check(CLI::Range(0.0, 100.0))
      ->check(isNumber())
      ->capture_default_str();
  verb.add_option("--hardfail", settings.fail.hard, "Difference that fails by itself")->check(notBelowZero());
  verb.add_option("--allowfailures", settings.allowedFailures, "Pixels of a layer that may exceed --fail")
      ->capture_default_str();
  verb.add_option("--warn", settings.warn.absolute, "As --fail, but only a warning")
      ->check(notBelowZero())
      ->capture_default_str();
  verb.add_option("--warnrelative", settings.warn.relative, "As --failrelative, but only a warning")
      ->check(notBelowZero())
      ->capture_default_str();
  verb.add_option("--warnpercent", settings.warn.percent, "As --failpercent, but only a warning")
      ->check(CLI::Range(0.0, 100.0))
      ->check(isNumber())
      ->capture_default_str();
  verb.add_option("--hardwarn", settings.warn.hard, "As --hardfail, but only a warning")->check(notBelowZero());
  verb.add_option("--metadata", metadata, "What a differing attribute does")
      ->check(CLI::IsMember({"fail", "warn", "ignore"}))
      ->capture_default_str();
  verb.add_option("--ignore-attribute", settings.ignoredAttributes, "Attributes that may differ")
      ->allow_extra_args(false);
  verb.add_option("--layer", settings.layers, "Compare only this layer; may be repeated")->allow_extra_args(false);
  verb.add_flag("--finite", settings.finiteOnly, "Fail on NaN and infinity even where both files hold the same");
  verb.add_flag("--json", json, "Print the report as JSON");
  verb.add_option("--html", html, "Write a self-contained page that shows both pictures and their difference");
  shown.addTo(verb, "--html");
}

void CompareFlags::writeHtml(const ExrDocument& one, const ExrDocument& other, const CompareReport& report) const {
  if (html.empty()) return;
  Page page = comparePage(one, other, report, {shown.shaderOf(one), shown.shaderOf(other)});
  page.exposure = shown.exposure;
  writePage(html, page);
}

CompareSettings CompareFlags::settings() const {
  CompareSettings settings = thresholds;
  settings.metadata = metadata == "fail"   ? MetadataRule::fail
                      : metadata == "warn" ? MetadataRule::warn
                                           : MetadataRule::ignore;
  return settings;
}

void addCompare(CLI::App& app) {
  auto flags = std::make_shared<CompareFlags>();
  auto sequence = std::make_shared<SequenceFlags>();
  CLI::App* verb = app.add_subcommand("compare", "A regression gate: exit code 1 when two EXR files differ");
  flags->addTo(*verb);
  sequence->addTo(*verb, {.sideBySide = false, .resumes = false});
  verb->callback([verb, flags, sequence] {
    TemporalError flicker;
    const auto compareFrame = [&](FrameRun& frame) {
      try {
        compareVerb(*flags, frame, flicker);
      } catch (const Error& error) {
        if (error.exitCode() != 1) flicker.forget();  // a frame is missing
        throw;
      }
    };
    overFrames(*verb, *sequence, {flags->json, compareFrame, printCompareTable});
  });
}

}  // namespace pellucid::cli
