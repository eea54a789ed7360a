#include "composite/pipeline/study_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>

#include "composite/pipeline/fit.h"
#include "composite/pipeline/refusals.h"
#include "composite/study/flip.h"
#include "composite/study/peak_memory.h"
#include "gbuffer/errors.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

// What the sums of a candidate are kept in, for the table.
std::string precisionOf(const Request& request) {
  if (const auto* listed = std::get_if<PaintListed>(&request.paint)) return listed->method.method->precision;
  return paintsBy<PaintSums>(request) ? tierRow(request.tier).name : "double";
}

StudyCandidate candidateOf(const Request& base, const std::string& name, Paint paint, int passes, Tier tier) {
  StudyCandidate candidate{name, "", base};
  Request& request = candidate.request;
  request.method = name;
  request.decided.reset();
  request.passes = passes;
  request.tier = tier;
  request.paint = std::move(paint);
  request.measure = false;
  request.layers.clear();
  dropUnread(request);
  candidate.precision = precisionOf(request);
  return candidate;
}

// What a row says of its method: the sums of the device, or what the method's own sums would take.
void describeRow(StudyRow& row, const StudyCandidate& candidate, const Result& result) {
  row.method = candidate.name;
  row.precision = candidate.precision;
  row.samples = candidate.request.passes;
  if (weighs(candidate.request)) row.weight = weightText(result.plan.pass.weight);
  const Paint& paint = candidate.request.paint;
  if (const auto* samples = std::get_if<PaintSamples>(&paint)) {
    row.bits = stochasticBits(samples->settings);
    row.passes = stochasticPasses(samples->settings);
  } else if (const auto* listed = std::get_if<PaintListed>(&paint)) {
    row.bits = listed->method.method->bits(listed->method.order);
    row.passes = listed->method.method->passes;
  } else if (std::holds_alternative<PaintSorted>(paint) || candidate.request.tier == Tier::exact) {
    row.passes = 2;  // solids, then lists
  } else {
    row.bits = result.counts.bitsPerPixel;
    row.passes = result.counts.passes;
  }
}

Image<glm::vec3> colourOf(const Image<glm::vec4>& picture) {
  Image<glm::vec3> rgb(picture.width(), picture.height());
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = glm::vec3(picture[i]);
  return rgb;
}

double totalOf(const Result& result) {
  double sum = 0.0;
  for (const auto& [name, seconds] : result.stages.seconds())
    if (name != kFitStage) sum += seconds;  // one for a sequence, by --weight-from
  return sum;
}

// Runs a request once, when shaders compile, and then some times; the row gets what the run of the median took.
Result timedRun(Compositor& compositor, const Request& request, int repeats, StudyRow& row) {
  Result result = compositor.run(request);
  const double first = totalOf(result);
  forgetPeakMemory();
  std::vector<std::pair<double, Stages>> runs;
  for (int i = 0; i < repeats; ++i) {
    result = compositor.run(request);
    runs.emplace_back(totalOf(result), result.stages);
  }
  row.peakBytes = peakMemory();
  std::stable_sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto& median = runs[runs.size() / 2];
  for (const auto& stage : median.second.seconds())
    if (stage.first != kFitStage) row.stages.push_back(stage);
  for (const auto& [name, seconds] : row.stages) row.seconds += seconds;
  row.spread = row.seconds > 0.0 ? 0.5 * (runs.back().first - runs.front().first) / row.seconds : 0.0;
  row.firstSeconds = std::max(first - row.seconds, 0.0);
  return result;
}

// The candidates, the truth first: sorted, at the most passes.
std::vector<std::size_t> orderOf(const std::vector<StudyCandidate>& candidates) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (paintsBy<PaintSorted>(candidates[i].request) && candidates[i].request.passes > candidates[best].request.passes)
      best = i;
  std::vector<std::size_t> order{best};
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (i != best) order.push_back(i);
  return order;
}

}  // namespace

namespace {

Request paintedBy(const Request& base, const Paint& paint, Tier tier) {
  Request request = base;
  request.paint = paint;
  request.tier = tier;
  return request;
}

bool isOfTiers(const Refusal& row) {
  return std::string(row.flag) == "--precision" && std::string(row.with).rfind("--method", 0) == 0;
}

bool takesTier(const Request& base, const Paint& paint, Tier tier) {
  const Request request = paintedBy(base, paint, tier);
  return std::none_of(refusals().begin(), refusals().end(),
                      [&](const Refusal& row) { return isOfTiers(row) && row.applies(request); });
}

// What some rows do not read is left out there; what none reads would do nothing.
void refuseUnread(const Request& base, const std::vector<std::string>& methods, const std::vector<Paint>& paints,
                  const std::vector<Tier>& tiers) {
  const auto expectAny = [&](const Refusal& row, Tier tier) {
    const auto reads = [&](const Paint& paint) { return !row.applies(paintedBy(base, paint, tier)); };
    if (std::none_of(paints.begin(), paints.end(), reads))
      throw UsageError(fmt::format("{}: found {} with --methods {}, expected {}: {}", row.flag, row.found,
                                   fmt::join(methods, ","), row.expected, row.why));
  };
  for (const Refusal& row : refusals()) {
    if (row.ofMethod() && !isOfTiers(row)) expectAny(row, Tier::float32);
    for (const Tier tier : tiers)
      if (isOfTiers(row)) expectAny(row, tier);
  }
}

// Of a method that is no row for each tier.
Tier tierFor(const Request& base, const Paint& paint, const std::vector<Tier>& tiers) {
  const auto found = std::find_if(tiers.begin(), tiers.end(), [&](Tier tier) { return takesTier(base, paint, tier); });
  return found == tiers.end() ? Tier::float32 : *found;
}

}  // namespace

std::vector<StudyCandidate> studyCandidates(const Request& base, const std::vector<std::string>& methods,
                                            const std::vector<int>& passes, const std::vector<Tier>& tiers,
                                            const std::function<Paint(const std::string&, int)>& paintOf) {
  std::vector<StudyCandidate> candidates;
  std::vector<Paint> paints;
  for (const std::string& name : methods) paints.push_back(paintOf(name, passes.front()));
  refuseUnread(base, methods, paints, tiers);
  for (const int count : passes) {
    candidates.push_back(candidateOf(base, "over", PaintSorted{}, count, Tier::float32));
    for (const std::string& name : methods) {
      const Paint paint = paintOf(name, count);
      const auto* listed = std::get_if<PaintListed>(&paint);
      const std::string shown = listed ? listed->method.name : name;
      if (!std::holds_alternative<PaintSums>(paint)) {
        candidates.push_back(candidateOf(base, shown, paint, count, tierFor(base, paint, tiers)));
        continue;
      }
      for (const Tier tier : tiers) candidates.push_back(candidateOf(base, shown, paint, count, tier));
    }
  }
  for (const StudyCandidate& candidate : candidates) validate(candidate.request);
  return candidates;
}

StudyOutcome runStudy(Compositor& compositor, const std::vector<StudyCandidate>& candidates, int repeats,
                      const std::function<void(std::size_t done, std::size_t all)>& begins) {
  Journal& journal = compositor.journal();
  StudyOutcome outcome;
  outcome.rows.resize(candidates.size());
  outcome.pictures.resize(candidates.size());
  Image<glm::vec4> truth;
  std::unique_ptr<FlipReference> flip;
  std::string device = "CPU";
  const std::vector<std::size_t> order = orderOf(candidates);
  for (std::size_t done = 0; done < order.size(); ++done) {
    if (begins) begins(done, order.size());
    const StudyCandidate& candidate = candidates[order[done]];
    StudyRow& row = outcome.rows[order[done]];
    compositor.light(candidate.request);  // which all rows of as many passes share: it is no cost of a method
    const Result result = timedRun(compositor, candidate.request, repeats, row);
    describeRow(row, candidate, result);
    if (result.device != "CPU") device = result.device;
    if (done == 0) {
      truth = result.picture.rgba;
      flip = std::make_unique<FlipReference>(truth);
    }
    row.error = measureError(result.picture.rgba, truth);
    row.relativeSquare = relativeSquareError(result.picture.rgba, truth);
    row.flip = meanOf(flip->map(result.picture.rgba));
    outcome.pictures[order[done]] = colourOf(result.picture.rgba);
    journal.note(fmt::format("study: {} of {}: {}, rmse {:.3g}, {:.3f} s", done + 1, order.size(), rowName(row),
                             row.error.rmse, row.seconds));
  }
  markFront(outcome.rows);
  const auto cores = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  outcome.machine =
      fmt::format("{} on {} threads; medians of {} runs after one that is not counted", device, cores, repeats);
  return outcome;
}

}  // namespace pellucid
