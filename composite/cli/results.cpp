#include "composite/cli/results.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "composite/pipeline/cheapest.h"
#include "gbuffer/errors.h"
#include "gbuffer/threads.h"

namespace pellucid::cli {

struct Threads::Impl {
  std::unique_ptr<tbb::global_control> control;
};

Threads::Threads(int count) : impl_(std::make_unique<Impl>()) {
  if (count > 0) {
    impl_->control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                           static_cast<std::size_t>(count));
    setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 1);
  }
  setExrThreads(count > 0 ? count : tbb::info::default_concurrency());
}

Threads::~Threads() = default;

namespace {

std::string clampText(const PublishedClamps& clamps) {
  return fmt::format("{} numbers of layers; sums of {} pixels (radiance), {} (diffusion), {} (refraction)",
                     clamps.written, clamps.radiance, clamps.diffusion, clamps.refraction);
}

std::string toleranceLine(double tolerance, const ToleranceCounts& counts) {
  const double all = static_cast<double>(counts.certified + counts.recomputed);
  std::string line = fmt::format(
      "tolerance {}: {:.1f}% of {} samples of pixels certified, {} composited exactly; no error above {:.3f} "
      "of it",
      tolerance, all > 0 ? 100.0 * static_cast<double>(counts.certified) / all : 100.0,
      counts.certified + counts.recomputed, counts.recomputed, counts.bound);
  if (counts.measured) line += fmt::format(", {:.3f} measured", *counts.measured);
  return line;
}

}  // namespace

nlohmann::json errorsOf(const Result& result) {
  nlohmann::json found = nlohmann::json::object();
  if (const auto* within = result.plan.as<PaintWithin>()) {
    const ToleranceCounts& counts = result.counts.tolerance;
    found["tolerance"] = {{"E", within->tolerance},
                          {"certified", counts.certified},
                          {"recomputed", counts.recomputed},
                          {"bound", counts.bound}};
    if (counts.measured) found["tolerance"]["measured"] = *counts.measured;
  }
  if (const std::optional<Choice>& choice = result.choice) {
    found["choice"] = {{"E", choice->tolerance},
                       {"layersPerPixel", choice->layers},
                       {"onProbes", choice->onProbes},
                       {"why", reasonOf(*choice)}};
    if (choice->measured) found["choice"]["measured"] = *choice->measured;
  }
  if (!result.error) return found;
  const ErrorStatistics& error = *result.error;
  const Window& data = result.dataWindow;
  found["error"] = {{"mean", error.mean},
                    {"rmse", error.rmse},
                    {"p99", error.p99},
                    {"max", error.maximum},
                    {"worst", {error.worstX + data.x0, error.worstY + data.y0}},
                    {"pixels", error.pixels},
                    {"notFinite", error.nonFinite}};
  return found;
}

nlohmann::json statisticsOf(const Stages& stages, const RunCounts& counts, const std::string& device) {
  nlohmann::json seconds = nlohmann::json::object();
  for (const auto& [name, value] : stages.seconds()) seconds[name] = value;
  nlohmann::json statistics{{"device", device},      {"triangles", counts.triangles}, {"chunks", counts.chunks},
                            {"tiles", counts.tiles}, {"fragments", counts.fragments}, {"seconds", seconds}};
  statistics["bitsPerPixel"] = counts.bitsPerPixel;
  statistics["solidBitsPerPixel"] = counts.solidBits;
  statistics["clamped"] = {{"written", counts.clamps.written},
                           {"radiance", counts.clamps.radiance},
                           {"diffusion", counts.clamps.diffusion},
                           {"refraction", counts.clamps.refraction}};
  statistics["passes"] = counts.passes;
  statistics["pruned"] = counts.pruned;
  return statistics;
}

void reportError(const RunFlags& flags, const Result& result, nlohmann::json& report) {
  report.update(errorsOf(result));
  if (flags.json) return;
  if (const auto* within = result.plan.as<PaintWithin>())
    fmt::print("{}\n", toleranceLine(within->tolerance, result.counts.tolerance));
  if (result.error) fmt::print("error of {} against sorted over: {}\n", result.plan.method, errorLine(*result.error));
}

void reportRun(const RunFlags& flags, const Stages& stages, const RunCounts& counts, const std::string& device,
               nlohmann::json& report) {
  if (counts.shadowRays)
    say(fmt::format("light on transparent things: asked {} times in {:.2f} s", counts.shadowRays,
                    counts.shadowSeconds));
  if (counts.clamps.total())
    say(fmt::format("published tier: clamped to what its targets hold: {}", clampText(counts.clamps)));
  if (flags.stats) {
    report["statistics"] = statisticsOf(stages, counts, device);
    if (!flags.json) {
      fmt::print("device      {}\ntriangles   {}\nchunks      {}\ntiles       {}\nfragments   {}\n", device,
                 counts.triangles, counts.chunks, counts.tiles, counts.fragments);
      if (counts.passes)
        fmt::print("planes      {} bits per pixel, and {} of solids\npasses      {}\n", counts.bitsPerPixel,
                   counts.solidBits, counts.passes);
      if (counts.clamps.total()) fmt::print("clamped     {}\n", clampText(counts.clamps));
      for (const std::string& reason : counts.pruned) fmt::print("pruned      {}\n", reason);
      for (const auto& [name, value] : stages.seconds()) fmt::print("{:<24}{:8.1f} ms\n", name, 1e3 * value);
    }
  }
  if (flags.json) fmt::print("{}\n", report.dump(2));
}

}  // namespace pellucid::cli
