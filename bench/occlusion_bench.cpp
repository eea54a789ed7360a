// What inferred occlusion costs of `composite`, as a user runs it: the sample foliage at 1080 and 2160 lines, and
// bottles, which has no leaf. Prints times and shares; --lines N measures that size alone.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

struct Timing {
  double total = 0.0;
  std::map<std::string, double> stages;
  nlohmann::json pruned;
  double of(const std::string& stage) const {
    const auto found = stages.find(stage);
    return found == stages.end() ? 0.0 : found->second;
  }
};

Ended require(const Ended& ended) {
  if (ended.code != 0) throw std::runtime_error(ended.err);
  return ended;
}

Timing composite(const std::string& stem, const std::string& occlusion) {
  const Ended ended =
      require(runProgram({"composite", stem + ".exr", stem + ".glb", "-o", stem + "-out.exr", "--json", "--stats",
                          "--occlusion", occlusion, "--method", "phenomenological", "--weight", "eq5"}));
  const nlohmann::json statistics = nlohmann::json::parse(ended.out).at("statistics");
  return {ended.seconds, statistics.at("seconds").get<std::map<std::string, double>>(), statistics.at("pruned")};
}

void measure(const std::string& sample, int lines) {
  const std::string folder = freshFolder("bench_occlusion");
  RunOptions options;
  options.program = "pellucid_samples";
  require(runProgram({folder, sample, std::to_string(lines)}, options));
  const std::string stem = folder + "/" + sample;
  const Timing off = composite(stem, "off"), on = composite(stem, "inferred");
  const double passes = on.of("transparent pass") - off.of("transparent pass");
  const double planes = on.of("depth of leaves") + on.of("occlusion of leaves");
  std::printf(
      "%-8s %4d lines: composite %6.2f s without, %6.2f s with inferred occlusion; of the latter %4.1f%% for the "
      "occluders (once), %4.1f%% more in the passes (8 samples)\n",
      sample.c_str(), lines, off.total, on.total, 100.0 * planes / on.total, 100.0 * passes / on.total);
  if (planes == 0.0) {
    for (const auto& reason : on.pruned)
      if (reason.get<std::string>().rfind("inferred occlusion", 0) == 0)
        std::printf("         nothing was done: %s\n", reason.get<std::string>().c_str());
  }
}

}  // namespace
}  // namespace pellucid

int main(int count, char** arguments) {
  try {
    const int only = count == 3 && std::string(arguments[1]) == "--lines" ? std::atoi(arguments[2]) : 0;
    for (const int lines : {1080, 2160})
      if (!only || only == lines) pellucid::measure("foliage", lines);
    if (only && only != 1080 && only != 2160) pellucid::measure("foliage", only);
    pellucid::measure("bottles", only ? only : 1080);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_occlusion: %s\n", error.what());
    return 1;
  }
}
