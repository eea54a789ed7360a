// What verbs share when they end: extra layers, statistics, threads.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "composite/cli/messages.h"
#include "composite/cli/options.h"
#include "composite/compare/compare.h"
#include "composite/pipeline/result.h"

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

// The same as data: what --tolerance and --measure found, each under its name where it was asked for.
nlohmann::json errorsOf(const Result& result);
// Counts, seconds and planes of a run, as --json puts them under `statistics`.
nlohmann::json statisticsOf(const Stages& stages, const RunCounts& counts, const std::string& device);
nlohmann::json jsonOf(const CompareReport& report);  // of `compare`

// Prints what --tolerance and --measure found, or puts it into the report.
void reportError(const RunFlags& flags, const Result& result, nlohmann::json& report);

// Prints --stats as text, or with --json the report with the statistics in it.
void reportRun(const RunFlags& flags, const Stages& stages, const RunCounts& counts, const std::string& device,
               nlohmann::json& report);

}  // namespace pellucid::cli
