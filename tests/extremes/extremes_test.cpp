// Every method and tier over the whole range of what layers may be: finite, as near to a double-precision sum as it
// says, monotone, and the same in millimetres and kilometres. PELLUCID_EXTREMES=N tries N seeds: ./dev campaign
// extremes N.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "gbuffer/opaque_io.h"
#include "tests/extremes/extreme_shot.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

// What a method says of itself. Errors are parts of the light that enters the pixel; kAny is of what approximates.
//   single  most of a pixel of one layer
//   all     most of any pixel
//   units   most difference between a shot in metres and the same in millimetres; kAny where the weight has lengths
//   least   light that is lost where a weight makes it smaller than a float is; the weights are at least 2^-86
struct Row {
  const char* method;
  std::vector<std::string> flags;
  double single, all, units, least;
  bool isMonotone = true;
};

constexpr double kAny = std::numeric_limits<double>::max();
constexpr double kRounding = 3e-7;     // of the few float steps from a double sum to the file
constexpr double kSumRounding = 2e-6;  // of float sums, their quotient and their product
constexpr double kFitted = 1e-2;       // of a weight that is fitted to each
// Moments count a quarter of a layer's own absorbance before it, which dims the light of layers under 1/1000 of
// opacity.
constexpr double kOwnQuarter = 2.5e-4;
constexpr double kTiny = 1e-30, kWeighed = 1e-12;

std::vector<Row> rows() {
  const auto exact = [](const char* method, std::vector<std::string> flags = {}) {
    return Row{method, std::move(flags), kRounding, kRounding, 0.0, kTiny};
  };
  const auto sums = [](std::vector<std::string> flags, double units, double least) {
    return Row{"phenomenological", std::move(flags), kSumRounding, kAny, units, least};
  };
  const auto fromLists = [](const char* method, double single, double units) {
    return Row{method, {}, single, kAny, units, kTiny};
  };
  const auto rough = [](const char* method, std::vector<std::string> flags, double units) {
    return Row{method, std::move(flags), kAny, kAny, units, kTiny, false};
  };
  return {exact("over"),
          exact("over", {"--precision", "exact"}),
          exact("mlab:4"),
          sums({}, kFitted, kWeighed),
          sums({"--precision", "exact"}, kFitted, kWeighed),
          sums({"--weight", "uniform"}, 0.0, kTiny),
          sums({"--weight", "eq5"}, kAny, kWeighed),
          sums({"--weight", "eq7"}, kAny, kWeighed),
          sums({"--weight", "eq10z"}, kAny, kWeighed),
          sums({"--weight", "linear"}, kAny, kWeighed),
          rough("phenomenological", {"--precision", "published"}, kAny),
          fromLists("blended", kSumRounding, 0.0),
          fromLists("average", kSumRounding, 0.0),
          fromLists("sum", kRounding, 0.0),
          fromLists("unsorted", kRounding, 0.0),
          fromLists("front+tail", kRounding, kAny),
          fromLists("wavelet:2", kRounding, kSumRounding),
          fromLists("moments:4", kOwnQuarter, kSumRounding),
          fromLists("moments:8", kOwnQuarter, kSumRounding),
          rough("listing3", {}, kAny),
          rough("listing4", {}, kAny),
          rough("monochrome", {}, kAny),
          rough("stochastic", {}, 0.0),
          rough("stochastic:basic", {}, 0.0)};
}

std::string nameOf(const Row& row) {
  std::string name = row.method;
  for (const std::string& flag : row.flags) name += " " + flag;
  return name;
}

struct Figures {
  std::size_t notFinite = 0, falls = 0, changed = 0;
  double single = 0.0, all = 0.0, units = 0.0;
  void add(const Figures& other) {
    notFinite += other.notFinite;
    falls += other.falls;
    changed += other.changed;
    single = std::max(single, other.single);
    all = std::max(all, other.all);
    units = std::max(units, other.units);
  }
};

Image<glm::vec4> painted(const ExtremeShot& shot, const Row& row, const std::vector<std::string>& more) {
  const std::string output = shot.picture + ".out.exr";
  std::vector<std::string> arguments{"composite", shot.picture, shot.layers, "-o",      output,
                                     "--aa",      "1",          "--method",  row.method};
  arguments.insert(arguments.end(), row.flags.begin(), row.flags.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Ended ended = runProgram(arguments);
  EXPECT_EQ(ended.code, 0) << nameOf(row) << ": " << ended.err;
  return ended.code == 0 ? readOpaque(output, {}).gbuffer.beauty : Image<glm::vec4>();
}

// What enters the pixel: the largest light among layers and background.
double lightOf(const ExtremePixel& pixel, std::size_t channel) {
  double most = std::abs(pixel.background[channel]);
  for (const reference::Layer& layer : pixel.layers) most = std::max(most, layer.reflected[channel]);
  return most;
}

void judgePixel(const ExtremePixel& pixel, const glm::vec4& got, const Row& row, Figures& figures) {
  const reference::Rgb truth = reference::sortedOver(pixel.layers, pixel.background);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = static_cast<double>(got[static_cast<int>(c)]);
    const auto background = static_cast<float>(pixel.background[c]);
    if (pixel.layers.empty()) {
      figures.changed += std::memcmp(&got[static_cast<int>(c)], &background, sizeof background) != 0;
      continue;
    }
    if (!std::isfinite(value)) {
      ++figures.notFinite;
      continue;
    }
    const double off = std::max(std::abs(value - truth[c]) - row.least, 0.0) / std::max(lightOf(pixel, c), kTiny);
    figures.all = std::max(figures.all, off);
    if (pixel.layers.size() == 1) figures.single = std::max(figures.single, off);
  }
}

// How often a ladder goes the wrong way, by more than roundings.
std::size_t fallsIn(const ExtremeShot& shot, const Ladder& ladder, const Image<glm::vec4>& got, double least) {
  const bool rises = ladder.varied == Quantity::radiance || ladder.varied == Quantity::background;
  std::size_t falls = 0;
  for (std::size_t k = 1; k < ladder.count; ++k) {
    const std::size_t i = ladder.first + k;
    for (int c = 0; c < 3; ++c) {
      const double step = static_cast<double>(got[i][c]) - static_cast<double>(got[i - 1][c]);
      const double rounding = kSumRounding * lightOf(shot.pixels[i], static_cast<std::size_t>(c)) + least;
      falls += rises ? step < -rounding : step > rounding;
    }
  }
  return falls;
}

Figures judge(const ExtremeShot& shot, const Row& row) {
  Figures figures;
  const Image<glm::vec4> metres = painted(shot, row, {});
  const Image<glm::vec4> millimetres = painted(shot, row, {"--unit", "0.001"});
  if (metres.empty() || millimetres.empty()) return {1, 0, 0, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < shot.pixels.size(); ++i) {
    judgePixel(shot.pixels[i], metres[i], row, figures);
    for (int c = 0; c < 3; ++c)
      figures.units =
          std::max(figures.units, std::abs(static_cast<double>(metres[i][c]) - static_cast<double>(millimetres[i][c])) /
                                      std::max(lightOf(shot.pixels[i], static_cast<std::size_t>(c)), kTiny));
  }
  for (const Ladder& ladder : shot.ladders) figures.falls += fallsIn(shot, ladder, metres, row.least);
  return figures;
}

int seeds() {
  const char* asked = std::getenv("PELLUCID_EXTREMES");
  return asked ? std::max(1, std::atoi(asked)) : 1;
}

TEST(Extremes, EveryMethodAndTierOverTheWholeRange) {
  const std::string folder = freshFolder("extremes");
  std::vector<ExtremeShot> shots;
  for (int seed = 1; seed <= seeds(); ++seed) {
    const std::string of = freshFolder("extremes-" + std::to_string(seed));
    shots.push_back(writeExtremeShot(of, static_cast<std::uint64_t>(seed)));
  }
  std::printf("%zu pixels each, %zu seeds\n%-44s %10s %9s %9s %6s %8s %9s\n", shots[0].pixels.size(), shots.size(),
              "method", "not finite", "one layer", "all", "falls", "changed", "1/1000");
  for (const Row& row : rows()) {
    Figures worst;
    for (const ExtremeShot& shot : shots) worst.add(judge(shot, row));
    std::printf("%-44s %10zu %9.1e %9.1e %6zu %8zu %9.1e\n", nameOf(row).c_str(), worst.notFinite, worst.single,
                worst.all, worst.falls, worst.changed, worst.units);
    EXPECT_EQ(worst.notFinite, 0u) << nameOf(row);
    EXPECT_EQ(worst.changed, 0u) << nameOf(row);
    EXPECT_LE(worst.single, row.single) << nameOf(row);
    EXPECT_LE(worst.all, row.all) << nameOf(row);
    EXPECT_LE(worst.units, row.units) << nameOf(row);
    EXPECT_LE(worst.falls, row.isMonotone ? 0 : shots[0].pixels.size()) << nameOf(row);
  }
}

// Powers of depth hold light up to 1e20.
TEST(Extremes, SumsThatOverflowAreSaid) {
  const ExtremeShot shot = writeExtremeShot(freshFolder("extremes-overflow"), 1);
  const auto saidWith = [&](const char* weight) {
    return runProgram({"composite", shot.picture, shot.layers, "-o", shot.picture + ".out.exr", "--aa", "1", "--method",
                       "phenomenological", "--weight", weight})
        .err;
  };
  const char* sentence = "pixels are not finite over a background that is, the first at ";
  EXPECT_NE(saidWith("power:32").find(sentence), std::string::npos);
  EXPECT_EQ(saidWith("uniform").find(sentence), std::string::npos);
}

}  // namespace
}  // namespace pellucid::test
