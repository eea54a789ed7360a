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

void reportError(const RunFlags& flags, const Result& result, nlohmann::json& report) {
  if (const auto* within = result.plan.as<PaintWithin>()) {
    const ToleranceCounts& counts = result.counts.tolerance;
    report["tolerance"] = {{"E", within->tolerance},
                           {"certified", counts.certified},
                           {"recomputed", counts.recomputed},
                           {"bound", counts.bound}};
    if (counts.measured) report["tolerance"]["measured"] = *counts.measured;
    if (!flags.json) fmt::print("{}\n", toleranceLine(within->tolerance, counts));
  }
  if (const std::optional<Choice>& choice = result.choice) {
    report["choice"] = {{"E", choice->tolerance},
                        {"layersPerPixel", choice->layers},
                        {"onProbes", choice->onProbes},
                        {"why", reasonOf(*choice)}};
    if (choice->measured) report["choice"]["measured"] = *choice->measured;
  }
  if (!result.error) return;
  const ErrorStatistics& error = *result.error;
  const Window& data = result.dataWindow;
  report["error"] = {{"mean", error.mean},
                     {"rmse", error.rmse},
                     {"p99", error.p99},
                     {"max", error.maximum},
                     {"worst", {error.worstX + data.x0, error.worstY + data.y0}},
                     {"pixels", error.pixels},
                     {"notFinite", error.nonFinite}};
  if (!flags.json) fmt::print("error of {} against sorted over: {}\n", result.plan.method, errorLine(error));
}

void reportRun(const RunFlags& flags, const Stages& stages, const RunCounts& counts, const std::string& device,
               nlohmann::json& report) {
  if (counts.shadowRays)
    say(fmt::format("light on transparent things: asked {} times in {:.2f} s", counts.shadowRays,
                    counts.shadowSeconds));
  if (counts.clamps.total())
    say(fmt::format("published tier: clamped to what its targets hold: {}", clampText(counts.clamps)));
  if (flags.stats) {
    nlohmann::json seconds = nlohmann::json::object();
    for (const auto& [name, value] : stages.seconds()) seconds[name] = value;
    report["statistics"] = {{"device", device},      {"triangles", counts.triangles}, {"chunks", counts.chunks},
                            {"tiles", counts.tiles}, {"fragments", counts.fragments}, {"seconds", seconds}};
    report["statistics"]["bitsPerPixel"] = counts.bitsPerPixel;
    report["statistics"]["solidBitsPerPixel"] = counts.solidBits;
    report["statistics"]["clamped"] = {{"written", counts.clamps.written},
                                       {"radiance", counts.clamps.radiance},
                                       {"diffusion", counts.clamps.diffusion},
                                       {"refraction", counts.clamps.refraction}};
    report["statistics"]["passes"] = counts.passes;
    report["statistics"]["pruned"] = counts.pruned;
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
