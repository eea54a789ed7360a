#include "bench/kernels.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <limits>

#include "composite/resolve.h"
#include "tests/support/random.h"

namespace pellucid::bench {
namespace {

constexpr int kWidth = 1920, kHeight = 1080, kRuns = 5;

// Processor seconds of all threads, the median of several runs after one that is not counted.
template <class Work>
double secondsOf(const Work& work) {
  std::vector<double> runs;
  for (int run = 0; run <= kRuns; ++run) {
    timespec start{}, end{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    work();
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    if (run > 0)
      runs.push_back(static_cast<double>(end.tv_sec - start.tv_sec) +
                     1e-9 * static_cast<double>(end.tv_nsec - start.tv_nsec));
  }
  std::sort(runs.begin(), runs.end());
  return runs[runs.size() / 2];
}

// Copies rows of some bytes, as many as make up `bytes`, read and written.
double copySeconds(std::size_t bytes) {
  const std::size_t row = 1 << 16, rows = bytes / 2 / row + 1;
  std::vector<char> from(row * rows, 1), to(row * rows, 0);
  return secondsOf([&] {
    tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t i) { std::memcpy(&to[i * row], &from[i * row], row); });
  });
}

OitPlanes filledPlanes() {
  OitPlanes planes = emptyPlanes({0, 0, kWidth, kHeight}, {0, 0, kWidth, kHeight});
  test::Random random(11);
  for (std::size_t i = 0; i < planes.radiance.size(); ++i) {
    const float opacity = 0.25f + 0.5f * random.uniformf();
    planes.radiance[i] = glm::vec4(0.5f * opacity);
    planes.weight[i] = glm::vec4(glm::vec3(opacity), 1.0f);
    planes.opacity[i] = glm::vec4(opacity);
    planes.depth[i] = glm::vec4(glm::vec3(opacity), 0.0f);
    planes.frontZ[i] = 4.0f;
  }
  return planes;
}

Ratio resolveRatio() {
  const OitPlanes planes = filledPlanes();
  constexpr std::size_t kBytes = std::size_t{kWidth} * kHeight * (5 * 16 + 4 + 16 + 12 + 12 + 4 + 1);
  const double ours = secondsOf([&] { resolve(planes, {}); }), copy = copySeconds(kBytes);
  Ratio ratio{"resolve without diffusion", "a copy of as many bytes", ours / copy, 0.0, 3.33, ""};
  ratio.figures = fmt::format("{:.1f}, {:.1f} ms", 1e3 * ours, 1e3 * copy);
  return ratio;
}

Ratio gatherRatio(float spread) {
  constexpr int kGlassWidth = 640, kGlassHeight = 360;
  test::Random random(7);
  Backdrop backdrop{Image<glm::vec4>(kGlassWidth, kGlassHeight), Image<float>(kGlassWidth, kGlassHeight, 20.0f)};
  for (std::size_t i = 0; i < backdrop.colour.size(); ++i)
    backdrop.colour[i] = glm::vec4(random.uniformf(), random.uniformf(), random.uniformf(), 1);
  OitPlanes planes = emptyPlanes({0, 0, kGlassWidth, kGlassHeight}, {0, 0, kGlassWidth, kGlassHeight});
  addScatterPlanes(planes);
  for (std::size_t i = 0; i < planes.refraction.size(); ++i) planes.refraction[i].w = spread * spread;
  std::fill(planes.diffuseZ.data(), planes.diffuseZ.data() + planes.diffuseZ.size(), 5.0f);
  Image<glm::vec4> seen(kGlassWidth, kGlassHeight);
  const double ours = secondsOf([&] {
    const Lookups lookups(backdrop, planes, {});
    tbb::parallel_for(0, kGlassHeight, [&](int y) {
      for (int x = 0; x < kGlassWidth; ++x) seen.at(x, y) = lookups.at(x, y);
    });
  });
  const double copy = copySeconds(2 * seen.size() * sizeof(glm::vec4));
  Ratio ratio{
      fmt::format("diffusing pixel, D {:g} px", spread), "a copy of the same pixels", ours / copy, 0.0, 0.0, ""};
  ratio.figures = fmt::format("{:.0f}, {:.2f} ns a pixel", 1e9 * ours / static_cast<double>(seen.size()),
                              1e9 * copy / static_cast<double>(seen.size()));
  return ratio;
}

}  // namespace

std::vector<Ratio> kernelRatios() {
  std::vector<Ratio> ratios{resolveRatio()};
  for (const float spread : {2.0f, 4.0f, 16.0f, 64.0f}) ratios.push_back(gatherRatio(spread));
  return ratios;
}

}  // namespace pellucid::bench
