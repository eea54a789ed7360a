// Costs of ours beside those of others, one run, one table: bench/RESULTS.md, and bench/ratios.json of the last
// release.
//   measure_costs PELLUCID PELLUCID_SAMPLES DEEP_FILE BENCH_FOLDER WORK_FOLDER table|release|check [RUNS]
// table writes the page, release the ratios as well; check writes nothing and exits 1 where a ratio is worse by 15%.
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "bench/kernels.h"
#include "bench/shots_cost.h"

namespace pellucid::bench {
namespace {

constexpr double kWorse = 0.15;

std::string machine() {
  std::string model = "an unknown processor", line;
  std::ifstream info("/proc/cpuinfo");
  while (std::getline(info, line))
    if (line.starts_with("model name")) {
      model = line.substr(line.find(':') + 2);
      break;
    }
  return fmt::format("{} cores of {}.", sysconf(_SC_NPROCESSORS_ONLN), model);
}

// Prints what was measured as soon as it was: the whole takes minutes.
void append(std::vector<Ratio>& all, const std::vector<Ratio>& more) {
  for (const Ratio& ratio : more) fmt::print("{:<58} {:>8.2f}   {}\n", ratio.name, ratio.value, ratio.figures);
  std::fflush(stdout);
  all.insert(all.end(), more.begin(), more.end());
}

int run(const std::vector<std::string>& words) {
  const std::string bench = words[3], mode = words[5];
  if (mode != "table" && mode != "release" && mode != "check")
    throw std::runtime_error("found '" + mode + "', expected table, release or check");
  Place place{words[0], words[1], words[4], words.size() > 6 ? std::atoi(words[6].c_str()) : 5};
  if (place.runs < 1) throw std::runtime_error("found '" + words[6] + "', expected a number of runs");
  std::filesystem::create_directories(place.folder);
  const std::string kept = bench + "/ratios.json";
  const std::vector<Ratio> before = readRatios(kept);
  if (mode == "check" && before.empty())
    throw std::runtime_error(kept + ": found no ratios, expected those that ./dev bench --table --release writes");
  std::vector<Ratio> now;
  append(now, kernelRatios());
  append(now, sampleRatios(place, "bottles", 4.0));
  append(now, sampleRatios(place, "smoke", 3.0));
  append(now, largeRatios(place));
  append(now, edgeRatios(place));
  append(now, shadowRatios(place));
  append(now, deepRatios(place, words[2]));
  const std::vector<std::string> sentences = worse(now, before, kWorse);
  for (const std::string& sentence : sentences) fmt::print("worse: {}\n", sentence);
  if (mode == "check") return sentences.empty() ? 0 : 1;
  std::ofstream page(bench + "/RESULTS.md");
  page << pageOf(now, before, scalingsOf(place), machine());
  if (!page.flush()) throw std::runtime_error(bench + "/RESULTS.md: cannot be written");
  if (mode == "release") writeRatios(kept, now);
  return 0;
}

}  // namespace
}  // namespace pellucid::bench

int main(int count, char** arguments) {
  try {
    if (count < 7) throw std::runtime_error("./dev bench --table says what it is given");
    return pellucid::bench::run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_costs: %s\n", error.what());
    return 2;
  }
}
