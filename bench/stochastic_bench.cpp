// What stochastic transparency costs on GL, as a multiple of one shaded pass over the same geometry (ST10 table 1 has
// 2.61 to 4.05 for S = 8); and the time of shadow maps beside that of rays.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <vector>

#include "composite/shadows.h"
#include "engine_bridge/embree/shadow_rays.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/gl/stochastic_pass.h"

namespace pellucid {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kEdge = 500;  // pixels, as in the paper
constexpr int kRuns = 5;

template <class Work>
double secondsOf(Work&& work) {
  std::vector<double> times;
  for (int i = 0; i < kRuns; ++i) {
    const auto start = Clock::now();
    work();
    times.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

// Sheets of smoke and glass, of 2 x 16 x 16 triangles each, lit by three lamps.
Scene sheets(int count) {
  constexpr int kCells = 16;
  Scene scene;
  Material smoke;
  smoke.name = "smoke";
  smoke.alphaMode = AlphaMode::blend;
  smoke.doubleSided = true;
  smoke.metallic = 0.0f;
  smoke.baseColor = {.6f, .6f, .7f, .3f};
  scene.materials = {smoke};
  for (int k = 0; k < count; ++k) {
    Primitive sheet;
    const float z = -3.0f - .1f * static_cast<float>(k);
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        Vertex vertex{};
        vertex.position = {2.0f * static_cast<float>(i) / kCells - 1.0f, 2.0f * static_cast<float>(j) / kCells - 1.0f,
                           z + .05f * std::sin(static_cast<float>(i + j + k))};
        vertex.normal = {0, 0, 1};
        sheet.vertices.push_back(vertex);
      }
    for (std::uint32_t j = 0; j < kCells; ++j)
      for (std::uint32_t i = 0; i < kCells; ++i) {
        const std::uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
        for (const std::uint32_t corner : {a, a + 1, b, b, a + 1, b + 1}) sheet.indices.push_back(corner);
      }
    Instance instance;
    instance.primitive = k;
    instance.identity = shading::hashOf(static_cast<std::uint32_t>(k));
    scene.primitives.push_back(std::move(sheet));
    scene.instances.push_back(instance);
  }
  for (int k = 0; k < 3; ++k) {
    Light lamp;
    lamp.name = "lamp";
    lamp.kind = k == 0 ? LightKind::directional : LightKind::point;
    lamp.intensity = 3.0f;
    lamp.position = {static_cast<double>(k), 2.0, -1.0};
    lamp.direction = glm::normalize(glm::dvec3(.2, -.3, -1));
    scene.lights.push_back(lamp);
  }
  return scene;
}

void measure(int layers) {
  const Scene scene = sheets(layers);
  GBuffer gbuffer;
  gbuffer.display = gbuffer.data = {0, 0, kEdge, kEdge};
  gbuffer.viewZ = Image<float>(kEdge, kEdge, 8.0f);
  Camera camera;
  camera.focal = {3, 3};
  GlContext context;
  PassSettings settings;
  settings.filter = TextureFilter::bilinear;
  ShadowMapSettings mapSettings;
  mapSettings.size = 2048;
  ShadowMapStatistics drawn;
  settings.shadows =
      std::make_shared<const ShadowMaps>(renderShadowMaps(context, scene, camera, nullptr, mapSettings, &drawn));
  TransparentPass pass(context, scene, gbuffer, camera);
  StochasticPass stochastic(context, scene, gbuffer, camera);
  // The base of the paper is one fully shaded, blended pass: our sums with their fewest targets are its like.
  pass.accumulate(settings);
  const double base = secondsOf([&] { pass.accumulate(settings); });
  for (const bool winners : {false, true})
    for (const int samples : {8, 64}) {
      StochasticPassSettings chosen;
      chosen.samples = samples;
      chosen.winnersOnly = winners;
      stochastic.sample(settings, chosen);
      double cover = 0, add = 0;
      const double whole = secondsOf([&] {
        stochastic.sample(settings, chosen);
        cover = stochastic.statistics().coverSeconds;
        add = stochastic.statistics().addSeconds;
      });
      std::printf("%2d layers, S = %2d, %s: %.3f s, %.2f of one shaded pass (%.3f s); depths %.3f s, light %.3f s\n",
                  layers, samples, winners ? "basic or alpha" : "depth", whole, whole / base, base, cover, add);
    }

  std::printf(
      "%2d layers, shadow maps of 3 lights, %d faces of 2048 and 1024: drawn in %.2f s, filtered in %.2f s, %zu MiB\n",
      layers, static_cast<int>(drawn.faces), drawn.drawSeconds, drawn.filterSeconds, drawn.bytes >> 20);
  const auto start = Clock::now();
  const ShadowRays rays(scene, camera);
  for (std::size_t light = 0; light < 3; ++light) rays.visibility(light, gbuffer, 1);
  const double traced = std::chrono::duration<double>(Clock::now() - start).count();
  const double looked = secondsOf([&] {
    for (std::size_t light = 0; light < 3; ++light) mappedVisibility(*settings.shadows, light, gbuffer, camera, 1);
  });
  std::printf("%2d layers, shadows of 3 lights on %d pixels: rays %.2f s, looked up in maps %.2f s\n", layers,
              kEdge * kEdge, traced, looked);
}

}  // namespace
}  // namespace pellucid

int main() {
  try {
    for (const int layers : {8, 32}) pellucid::measure(layers);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_stochastic: %s\n", error.what());
    return 1;
  }
}
