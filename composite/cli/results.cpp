#include "composite/cli/results.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

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

void addLayersOption(CLI::App& verb, std::vector<std::string>& layers) {
  verb.add_option("--layers", layers,
                  "Layers to add: transparent, transmission, depth; for debugging D, delta, weight, count")
      ->delimiter(',')
      ->check(CLI::IsMember({"transparent", "transmission", "depth", "D", "delta", "weight", "count"}));
}

ExtraLayer beautyLayer(const Image<glm::vec4>& rgba) {
  ExtraLayer layer;
  const char* names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) {
    Image<float> plane(rgba.width(), rgba.height());
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = rgba[i][c];
    layer.channels.emplace_back(names[c], std::move(plane));
  }
  return layer;
}

std::vector<ExtraLayer> requestedLayers(const std::vector<std::string>& layers, const Veil& veil) {
  const int width = veil.touched.width(), height = veil.touched.height();
  std::vector<ExtraLayer> result;
  const auto plane = [&](auto&& value) {
    Image<float> image(width, height);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = value(i);
    return image;
  };
  const char* names[] = {"R", "G", "B"};
  for (const std::string& name : layers) {
    ExtraLayer layer{name == "depth" ? "transparent" : name, {}};
    if (name == "transparent") {
      for (int c = 0; c < 3; ++c)
        layer.channels.emplace_back(names[c], plane([&](std::size_t i) { return veil.light[i][c]; }));
      layer.channels.emplace_back("A", plane([&](std::size_t i) {
                                    return veil.touched[i] ? shading::alphaOver(veil.transmission[i], 0.0f) : 0.0f;
                                  }));
    } else if (name == "transmission") {
      for (int c = 0; c < 3; ++c)
        layer.channels.emplace_back(names[c], plane([&](std::size_t i) { return veil.transmission[i][c]; }));
    } else if (name == "depth") {
      layer.channels.emplace_back("Z", plane([&](std::size_t i) { return veil.frontZ[i]; }));
    }
    if (!layer.channels.empty()) result.push_back(std::move(layer));
  }
  return result;
}

namespace {

std::string clampText(const PublishedClamps& clamps) {
  return fmt::format("{} numbers of layers; sums of {} pixels (radiance), {} (diffusion), {} (refraction)",
                     clamps.written, clamps.radiance, clamps.diffusion, clamps.refraction);
}

}  // namespace

void refusePublishedLayers(const std::vector<std::string>& layers) {
  for (const std::string& name : layers)
    if (name == "depth" || name == "weight" || name == "count")
      throw UsageError(fmt::format("--layers: found {} with the published tier, whose targets do not hold it", name));
}

void reportRun(const RunFlags& flags, const Stages& stages, const RenderCounts& counts, const std::string& device,
               nlohmann::json& report) {
  if (counts.clamps.total())
    spdlog::warn("published tier: clamped to what its targets hold: {}", clampText(counts.clamps));
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
