// Primary rays of `gbuffer` against Embree called bare, on one mesh: the height field of a million triangles that
// Embree's own packets are usually measured on. Prints the ratio; the aim is at least 0.6.
#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "engine_bridge/embree/opaque_scene.h"

namespace pellucid::rays {
namespace {

constexpr int kWidth = 1920, kHeight = 1080, kEdge = 708;

Scene heightField() {
  Scene scene;
  Material material;
  material.doubleSided = true;
  scene.materials.push_back(material);
  Primitive field;
  for (int j = 0; j <= kEdge; ++j)
    for (int i = 0; i <= kEdge; ++i) {
      const float x = 20.0f * static_cast<float>(i) / kEdge - 10.0f, y = 20.0f * static_cast<float>(j) / kEdge;
      Vertex vertex{};
      vertex.position = {
          x, 0.6f * std::sin(x * 2.1f) * std::cos(y * 1.7f) + 0.05f * std::sin(x * 31.0f) * std::sin(y * 29.0f) - 1.5f,
          -y - 1.0f};
      vertex.normal = {0, 1, 0};
      vertex.colour = glm::vec4(1.0f);
      field.vertices.push_back(vertex);
    }
  for (std::uint32_t j = 0; j < kEdge; ++j)
    for (std::uint32_t i = 0; i < kEdge; ++i) {
      const std::uint32_t a = j * (kEdge + 1) + i, b = a + 1, c = a + kEdge + 1, d = c + 1;
      for (const std::uint32_t corner : {a, b, d, a, d, c}) field.indices.push_back(corner);
    }
  scene.primitives.push_back(std::move(field));
  scene.instances.push_back({});
  return scene;
}

// Rays of slope 0.9 to the sides, a little downwards.
Camera camera() {
  Camera result;
  result.focal = {1.0 / 0.9, 1.0 / (0.9 * kHeight / kWidth)};
  result.centre = {0.0, 0.25 * result.focal.y};
  return result;
}

const Scene& scene() {
  static const Scene one = heightField();
  return one;
}

void gbufferRays(benchmark::State& state) {
  const OpaqueScene traced(scene(), camera());
  const CameraRays rays(camera(), {0, 0, kWidth, kHeight});
  for (auto _ : state)
    tbb::parallel_for(0, kHeight / 4, [&](int row) {
      BlockHits hits;
      for (int x = 0; x < kWidth; x += 4) {
        traced.traceBlock(rays, x, 4 * row, hits);
        benchmark::DoNotOptimize(hits);
      }
    });
  state.counters["Mrays/s"] =
      benchmark::Counter(1e-6 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

void bareRays(benchmark::State& state) {
  const Device device;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const Primitive& field = scene().primitives[0];
  auto* corners = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, field.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, field.indices.size() / 3));
  for (std::size_t i = 0; i < field.vertices.size(); ++i)
    for (int c = 0; c < 3; ++c) corners[3 * i + static_cast<std::size_t>(c)] = field.vertices[i].position[c];
  std::copy(field.indices.begin(), field.indices.end(), indices);
  rtcCommitGeometry(geometry);
  const SceneHandle bare(device);
  rtcAttachGeometry(bare, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(bare);
  for (auto _ : state)
    tbb::parallel_for(0, kHeight / 4, [&](int row) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      alignas(64) int valid[16];
      std::fill(valid, valid + 16, -1);
      for (int x = 0; x < kWidth; x += 4) {
        RTCRayHit16 packet;
        for (int k = 0; k < 16; ++k) {
          packet.ray.org_x[k] = packet.ray.org_y[k] = packet.ray.org_z[k] = 0.0f;
          packet.ray.dir_x[k] = ((static_cast<float>(x + k % 4) + 0.5f) / kWidth * 2.0f - 1.0f) * 0.9f;
          packet.ray.dir_y[k] =
              (1.0f - (static_cast<float>(4 * row + k / 4) + 0.5f) / kHeight * 2.0f) * 0.9f * kHeight / kWidth - 0.25f;
          packet.ray.dir_z[k] = -1.0f;
          packet.ray.tnear[k] = packet.ray.time[k] = 0.0f;
          packet.ray.tfar[k] = 1e30f;
          packet.ray.mask[k] = 0xffffffffu;
          packet.ray.flags[k] = 0;
          packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid, bare, &context, &packet);
        benchmark::DoNotOptimize(packet);
      }
    });
  state.counters["Mrays/s"] =
      benchmark::Counter(1e-6 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate);
}

// Wall time: the work is spread over threads.
BENCHMARK(gbufferRays)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(bareRays)->UseRealTime()->Unit(benchmark::kMillisecond);

// Keeps the rates for the ratio at the end.
class Rates : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) rates_[run.run_name.function_name] = run.counters.at("Mrays/s");
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    if (rates_.count("gbufferRays") && rates_.count("bareRays"))
      std::printf("gbufferRays / bareRays: %.2f (aim: at least 0.60)\n", rates_["gbufferRays"] / rates_["bareRays"]);
  }

 private:
  std::map<std::string, double> rates_;
};

}  // namespace
}  // namespace pellucid::rays

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  pellucid::rays::Rates rates;
  benchmark::RunSpecifiedBenchmarks(&rates);
  benchmark::Shutdown();
  return 0;
}
