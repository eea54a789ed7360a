// What exactness costs: sorted over against the weighted sums, from the same lists, and a deep file flattened.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <limits>
#include <string>

#include "composite/deep/flatten.h"
#include "composite/fold.h"
#include "composite/methods/method.h"
#include "composite/over.h"
#include "composite/resolve.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using test::Random;
constexpr Window kFullHd{0, 0, 1920, 1080};

Fragment randomFragment(Random& random) {
  Fragment fragment{};
  fragment.coverage = random.uniformf();
  fragment.radiance = fragment.coverage * glm::vec3(random.uniformf(), random.uniformf(), random.uniformf());
  fragment.z = 1.0f + 50.0f * random.uniformf();
  return fragment;
}

FragmentLists listsOf(const Window& window, std::uint64_t layers) {
  Random random(7);
  FragmentLists lists;
  lists.window = window;
  lists.solid =
      Image<glm::vec4>(window.width(), window.height(), glm::vec4(0, 0, 0, std::numeric_limits<float>::infinity()));
  lists.fragments.resize(lists.solid.size() * layers);
  for (Fragment& fragment : lists.fragments) fragment = randomFragment(random);
  for (std::size_t i = 0; i <= lists.solid.size(); ++i) lists.offsets.push_back(i * layers);
  return lists;
}

// A band of 135 rows eight times over stands for 1920 x 1080: the lists of a whole frame are 1.6 GB.
constexpr int kBands = 8;
constexpr Window kBand{0, 0, 1920, 135};

void BM_Over(benchmark::State& state) {
  const FragmentLists lists = listsOf(kBand, static_cast<std::uint64_t>(state.range(0)));
  Veil veil(kBand.width(), kBand.height());
  for (auto _ : state)
    for (int band = 0; band < kBands; ++band) compositeSorted(lists, kBand, veil);
}
BENCHMARK(BM_Over)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_Weighted(benchmark::State& state) {
  const FragmentLists lists = listsOf(kBand, static_cast<std::uint64_t>(state.range(0)));
  for (auto _ : state)
    for (int band = 0; band < kBands; ++band) {
      OitPlanes planes = emptyPlanes(kBand, kBand);
      foldFragments(lists, {shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f}, shading::PLD_NORMALISE_SPECTRAL,
                    planes);
      benchmark::DoNotOptimize(resolve(planes, {}));
    }
}
BENCHMARK(BM_Weighted)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();

// Cost against layers, one picture of 64 x 64: a curve per method and its fit.
constexpr Window kSmall{0, 0, 64, 64};

void curve(benchmark::State& state, const std::string& name) {
  const FragmentLists lists = listsOf(kSmall, static_cast<std::uint64_t>(state.range(0)));
  Veil veil(kSmall.width(), kSmall.height());
  const std::optional<ChosenMethod> method = chooseMethod(name);
  const MethodChoice choice{0, {shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f}, shading::PLD_NORMALISE_SPECTRAL};
  for (auto _ : state)
    if (method)
      compositeBy(*method, choice, lists, kSmall, veil);
    else
      compositeSorted(lists, kSmall, veil);
  state.SetComplexityN(state.range(0));
}

void registerCurves() {
  std::vector<std::string> names{"over"};
  for (const Method& method : methods()) names.push_back(method.name);
  for (const std::string& name : names)
    benchmark::RegisterBenchmark(("Layers/" + name).c_str(), [name](benchmark::State& state) { curve(state, name); })
        ->RangeMultiplier(4)
        ->Range(1, 1024)
        ->Complexity(name == "over" ? benchmark::oNLogN : benchmark::oN)
        ->Unit(benchmark::kMicrosecond)
        ->UseRealTime();
}

// 1920 x 1080, float, unsorted.
void BM_FlattenDeep(benchmark::State& state) {
  const auto samples = static_cast<std::uint64_t>(state.range(0));
  const std::string path = "/tmp/pellucid-bench-" + std::to_string(getpid()) + ".exr";
  DeepHeader header;
  header.display = header.data = kFullHd;
  header.channels = {"R", "G", "B", "A", "Z"};
  DeepWriter writer(path, header);
  Random random(3);
  for (int y = 0; y < kFullHd.height(); ++y) {
    DeepRows rows;
    rows.window = {0, y, kFullHd.x1, y + 1};
    rows.channels.resize(5);
    for (int x = 0; x <= kFullHd.width(); ++x) rows.offsets.push_back(static_cast<std::uint64_t>(x) * samples);
    for (std::uint64_t i = 0; i < rows.offsets.back(); ++i) {
      const Fragment fragment = randomFragment(random);
      const float values[] = {fragment.radiance.r, fragment.radiance.g, fragment.radiance.b, fragment.coverage,
                              fragment.z};
      for (std::size_t c = 0; c < 5; ++c) rows.channels[c].push_back(values[c]);
    }
    writer.write(rows);
  }
  writer.finish();
  for (auto _ : state) benchmark::DoNotOptimize(flattenDeep({path}));
  std::remove(path.c_str());
}
BENCHMARK(BM_FlattenDeep)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);

}  // namespace

void registerLayerCurves() {
  registerCurves();
}

}  // namespace pellucid

int main(int count, char** arguments) {
  pellucid::registerLayerCurves();
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
