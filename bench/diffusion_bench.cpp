// The fast gather's cost must not depend on how far light is spread: D = 64 px against D = 4 px, with one spread for
// all pixels and with a map full of edges, and against the exact gather.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "composite/gather.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr int kWidth = 640, kHeight = 360;

struct Scene {
  Backdrop backdrop;
  OitPlanes planes;
};

Scene emptyScene() {
  test::Random random(7);
  Scene scene;
  scene.backdrop.colour = Image<glm::vec4>(kWidth, kHeight);
  scene.backdrop.z = Image<float>(kWidth, kHeight, 20.0f);
  for (std::size_t i = 0; i < scene.backdrop.colour.size(); ++i)
    scene.backdrop.colour[i] = glm::vec4(random.uniformf(), random.uniformf(), random.uniformf(), 1);
  scene.planes = emptyPlanes({0, 0, kWidth, kHeight}, {0, 0, kWidth, kHeight});
  addScatterPlanes(scene.planes);
  return scene;
}

void diffuse(Scene& scene, int x, int y, float spread) {
  scene.planes.refraction.at(x, y).w = spread * spread;
  scene.planes.diffuseZ.at(x, y) = spread > 0.0f ? 5.0f : std::numeric_limits<float>::infinity();
}

// One spread everywhere.
Scene plain(float spread) {
  Scene scene = emptyScene();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) diffuse(scene, x, y, spread);
  return scene;
}

// Panes of four spreads, none among them, in cells of 40 px, with posts of 4 px in front of the glass.
Scene edges(float spread) {
  Scene scene = emptyScene();
  const float part[] = {1.0f, 0.5f, 0.0f, 0.2f};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      diffuse(scene, x, y, spread * part[(x / 40 + 2 * (y / 40)) % 4]);
      if (x % 64 < 4) scene.backdrop.z.at(x, y) = 2.0f;
    }
  return scene;
}

double secondsOf(const Scene& scene, bool exact) {
  LookupSettings settings;
  settings.exact = exact;
  double best = 1e9;
  glm::vec4 sum(0.0f);
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const Lookups lookups(scene.backdrop, scene.planes, settings);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (lookups.scattersAt(x, y)) sum += lookups.at(x, y);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  if (!(sum.r >= 0.0f)) std::printf("the sums are not finite\n");  // and keeps them from being left out
  return best;
}

void measure(const char* name, Scene (*make)(float)) {
  const double first = secondsOf(make(4.0f), false);
  for (const float spread : {4.0f, 8.0f, 16.0f, 32.0f, 64.0f}) {
    const double seconds = spread == 4.0f ? first : secondsOf(make(spread), false);
    std::printf("%s D = %2.0f px   %8.1f ms   %.2f times that of D = 4 px\n", name, static_cast<double>(spread),
                1e3 * seconds, seconds / first);
  }
}

}  // namespace
}  // namespace pellucid

int main() {
  using namespace pellucid;
  measure("fast gather, one spread         ", plain);
  measure("fast gather, edges everywhere   ", edges);
  std::printf("exact gather, one spread          D =  4 px   %8.1f ms\n", 1e3 * secondsOf(plain(4.0f), true));
}
