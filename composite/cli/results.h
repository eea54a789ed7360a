// What verbs share when they end: extra layers, statistics, threads.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "composite/cli/options.h"
#include "composite/cli/render.h"

namespace pellucid::cli {

// Sets the number of threads of TBB, OpenEXR and, before a context exists, llvmpipe. 0 leaves them at all cores.
class Threads {
 public:
  explicit Threads(int count);
  ~Threads();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

void addLayersOption(CLI::App& verb, std::vector<std::string>& layers);
ExtraLayer beautyLayer(const Image<glm::vec4>& rgba);  // R, G, B, A without a layer's name
std::vector<ExtraLayer> requestedLayers(const std::vector<std::string>& layers, const Veil& veil);

// Throws UsageError for a layer that the published tier cannot give.
void refusePublishedLayers(const std::vector<std::string>& layers);

// Prints --stats as text, or with --json the report with the statistics in it.
void reportRun(const RunFlags& flags, const Stages& stages, const RenderCounts& counts, const std::string& device,
               nlohmann::json& report);

}  // namespace pellucid::cli
