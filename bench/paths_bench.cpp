// What exactness costs as a user runs it: sixteen panes that each cover 1920 x 1080, through `composite` by the truth,
// by the weighted sums, and by sums whose weight is fitted to the truth. Medians of the stages between reading and
// writing.
//   bench_paths [LAYERS]
//   bench_paths shots PELLUCID_SAMPLES    each sample at 640 x 360 by the truth, which is the default, and by the sums
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;
constexpr int kWidth = 1920, kHeight = 1080, kRuns = 5;

void require(const Ended& ended) {
  if (ended.code != 0) throw std::runtime_error(ended.err);
}

std::string makeShot(int layers) {
  const std::string folder = freshFolder("bench_paths");
  std::vector<Quad> panes;
  for (int i = 0; i < layers; ++i) {
    // Out of order in depth, as scenes are.
    const float z = -2.0f - static_cast<float>(i * 7 % layers), half = -z;
    const float tint = static_cast<float>(i % 5) * 0.2f;
    panes.push_back({{-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0}, unlit(tint, 0.5f, 1.0f - tint, 0.25f)});
  }
  writeGlb(folder + "/panes.glb", panes);
  const std::string wall = std::to_string(kWidth) + "x" + std::to_string(kHeight);
  const std::string command = "oiiotool --pattern constant:color=.8,.7,.6,100 " + wall +
                              " 4 --chnames R,G,B,Z -d float -o " + folder + "/wall.exr";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("oiiotool could not write the wall");
  return folder;
}

double medianSeconds(const std::string& opaque, const std::string& scene, const std::vector<std::string>& flags) {
  std::vector<double> runs;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<std::string> arguments = {"composite", opaque, scene, "-o", opaque + ".out.exr", "--stats", "--json"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Ended ended = runProgram(arguments);
    require(ended);
    double sum = 0;
    const auto report = nlohmann::json::parse(ended.out);
    for (const auto& [stage, seconds] : report["statistics"]["seconds"].items())
      if (stage != "read scene" && stage != "read picture" && stage != "write" && stage != "GL context")
        sum += seconds.get<double>();
    runs.push_back(sum);
  }
  std::sort(runs.begin(), runs.end());
  return runs[kRuns / 2];
}

void panes(int layers) {
  const std::string folder = makeShot(layers);
  double weighted = 0;
  const std::pair<const char*, std::vector<std::string>> paths[] = {
      {"weighted", {"--method", "weighted", "--weight", "eq5"}},
      {"weighted, fitted weight", {"--method", "weighted", "--weight", "auto"}},
      {"over", {"--method", "over"}},
      {"front+tail", {"--method", "front+tail"}},
      {"exact sums", {"--method", "phenomenological", "--precision", "exact", "--weight", "eq5"}}};
  for (auto [name, flags] : paths) {
    flags.insert(flags.end(), {"--aa", "1"});
    const double seconds = medianSeconds(folder + "/wall.exr", folder + "/panes.glb", flags);
    if (weighted == 0) weighted = seconds;
    std::printf("%-24s %d layers, 1920 x 1080: %6.2f s, %.2f times weighted\n", name, layers, seconds,
                seconds / weighted);
  }
}

void shots(const std::string& generator) {
  const std::string folder = freshFolder("bench_paths");
  std::vector<double> ratios;
  for (const char* name :
       {"ball", "bars", "bottles", "cad", "chess", "clouds", "foliage", "frosted", "mixed", "smoke", "street"}) {
    if (std::system((generator + " " + folder + " " + name + " > " + folder + "/log").c_str()) != 0)
      throw std::runtime_error(std::string(name) + " could not be made");
    const std::string opaque = folder + "/" + name + ".exr", scene = folder + "/" + name + ".glb";
    // The weight is stated, as in all but the first frame of a sequence; the fit stands beside it.
    const double sums = medianSeconds(opaque, scene, {"--method", "phenomenological", "--weight", "eq5"}),
                 fitted = medianSeconds(opaque, scene, {"--method", "phenomenological"}),
                 over = medianSeconds(opaque, scene, {});
    ratios.push_back(over / sums);
    std::printf("%-10s sums %.2f s, with a fit %.2f s, over %.2f s: %.2f times\n", name, sums, fitted, over,
                ratios.back());
    std::fflush(stdout);
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("over / sums: %.2f to %.2f, median %.2f\n", ratios.front(), ratios.back(), ratios[ratios.size() / 2]);
}

}  // namespace
}  // namespace pellucid

int main(int count, char** arguments) {
  try {
    if (count == 3 && std::string(arguments[1]) == "shots") {
      pellucid::shots(arguments[2]);
      return 0;
    }
    const int layers = count > 1 ? std::atoi(arguments[1]) : 16;
    if (layers < 1) throw std::runtime_error("expected a number of layers, or `shots` and the program that makes them");
    pellucid::panes(layers);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_paths: %s\n", error.what());
    return 1;
  }
}
