// A ball of smoke of 100,000 and of a million particles at 1080p, self-shadowed: time of each stage, and memory.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace pellucid::bench {
namespace {

test::Ended must(const std::vector<std::string>& arguments, const std::string& program, const std::string& folder) {
  test::RunOptions options;
  options.program = program;
  options.folder = folder;
  test::Ended ended = test::runProgram(arguments, options);
  if (ended.code == 0) return ended;
  std::fprintf(stderr, "%s: exit code %d: %s\n", program.c_str(), ended.code, ended.err.c_str());
  std::exit(1);
}

void measure(const std::string& particles, const std::string& height, const std::string& budget,
             const std::string& folder) {
  must({".", "smokeball", height, "--particles", particles}, "pellucid_samples", folder);
  std::printf("%s particles, %s rows, --budget %s, file %.1f MiB\n", particles.c_str(), height.c_str(), budget.c_str(),
              static_cast<double>(std::filesystem::file_size(folder + "/smokeball.glb")) / 1048576.0);
  for (const std::string method : {"phenomenological", "over"}) {
    const test::Ended ended = must({"composite", "smokeball.exr", "smokeball.glb", "-o", "out.exr", "--aa", "1",
                                    "--budget", budget, "--method", method, "--stats", "--json"},
                                   "pellucid", folder);
    const nlohmann::json statistics = nlohmann::json::parse(ended.out).at("statistics");
    std::printf("  %s: %.2f s whole process, peak %.0f MiB, %.1f M fragments, %d chunks\n", method.c_str(),
                ended.seconds, static_cast<double>(ended.peakBytes) / 1048576.0,
                1e-6 * statistics.at("fragments").get<double>(), statistics.at("chunks").get<int>());
    for (const auto& [name, seconds] : statistics.at("seconds").items())
      std::printf("    %-20s %8.1f ms\n", name.c_str(), 1e3 * seconds.get<double>());
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace pellucid::bench

// bench_particles [HEIGHT]
int main(int count, char** arguments) {
  const std::string height = count > 1 ? arguments[1] : "1080";
  const std::string folder = std::string(PELLUCID_BINARY_DIR) + "/particles-bench-" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  pellucid::bench::measure("100000", height, "256M", folder);
  pellucid::bench::measure("1000000", height, "64M", folder);
  std::filesystem::remove_all(folder);
  return 0;
}
