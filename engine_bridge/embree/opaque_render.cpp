#include "engine_bridge/embree/opaque_render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "engine_bridge/embree/point_lighting.h"
#include "engine_bridge/embree/sampling.h"

namespace pellucid {
namespace {

using namespace rays;

// What sample points are for. Different uses of a pixel get independent sets.
enum Use : std::uint32_t { kPixel = 1, kSurroundings, kOpenness };
constexpr int kBlock = 4;
constexpr int kDirectionsPerSample = 2;  // of the surroundings

struct Colour {
  std::vector<glm::vec3> lights;
  glm::vec3 indirect{0.0f}, emission{0.0f}, behind{0.0f};
  float alpha = 0;
};

// Places of a pixel filter, looked up: every pixel of a picture asks for as many as it has samples.
class FilterPlaces {
 public:
  explicit FilterPlaces(const PixelFilter& filter) {
    if (filter.isPixelSquare()) return;
    for (int i = 0; i <= kSteps; ++i)
      places_.push_back(static_cast<float>(filter.placed(glm::dvec2(static_cast<double>(i) / kSteps)).x));
  }
  glm::vec2 of(glm::vec2 even) const { return places_.empty() ? even : glm::vec2(along(even.x), along(even.y)); }

 private:
  static constexpr int kSteps = 4096;
  float along(float even) const {  // [0,1)
    const float at = even * kSteps;
    const auto i = static_cast<std::size_t>(at);
    return glm::mix(places_[i], places_[i + 1], at - static_cast<float>(i));
  }
  std::vector<float> places_;  // along one axis
};

class OpaqueRenderer {
 public:
  OpaqueRenderer(const Scene& scene, const Camera& camera, const Window& display, const Window& data,
                 const Environment& environment, const OpaqueRenderSettings& settings)
      : scene_(scene),
        settings_(settings),
        places_(settings.pixelFilter),
        environment_(environment),
        traced_(scene, camera),
        rays_(camera, display),
        lighting_(traced_, environment, camera, settings.shadows),
        sampler_(scene, TexelFilter::bilinear),
        lights_(lightBlocks(scene.lights, camera)),
        worldFromView_(glm::transpose(glm::dmat3(camera.viewFromWorld))),
        planes_(emptyOpaquePlanes(data, lightLayerNames(scene.lights), settings.aoRadius > 0.0f, !environment.black(),
                                  opaqueEmits(scene))) {}

  OpaquePlanes render();

 private:
  struct Seen {  // a hit, understood
    ShadePoint point;
    bool unlit;
    double z;
  };
  std::optional<Seen> look(const Ray& ray, std::uint32_t instance, std::uint32_t triangle) const;
  void block(int x, int y);
  void centre(int column, int row, const Seen& seen);
  void addColour(const Ray& ray, const std::optional<Seen>& seen, int x, int y, int sample, Colour& sum) const;
  void store(int column, int row, const Colour& sum);

  const Scene& scene_;
  const OpaqueRenderSettings& settings_;
  FilterPlaces places_;
  const Environment& environment_;
  OpaqueScene traced_;
  CameraRays rays_;
  Lighting lighting_;
  SurfaceSampler sampler_;
  std::vector<PunctualLight> lights_;
  glm::mat3 worldFromView_;
  OpaquePlanes planes_;
};

std::optional<OpaqueRenderer::Seen> OpaqueRenderer::look(const Ray& ray, std::uint32_t instance,
                                                         std::uint32_t triangle) const {
  if (instance == kMissed) return std::nullopt;
  const Placed& placed = traced_.placed(instance);
  const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(scene_.instances[instance].primitive)];
  const Corners corners = cornersOf(primitive, placed.viewFromObject, triangle);
  // Embree found the triangle; where on it is worked out again in double.
  const std::optional<TriangleHit> hit = intersectPlane(ray, corners);
  if (!hit || !(hit->z > 0.0)) return std::nullopt;
  const Attributes attributes = attributesAt(primitive, placed, triangle, *hit);
  Seen seen;
  seen.z = hit->z;
  seen.unlit = scene_.materials[static_cast<std::size_t>(primitive.material)].unlit;
  ShadePoint& point = seen.point;
  point.position = glm::vec3(ray.origin + hit->z * ray.direction);
  point.toEye = rays_.orthographic() ? glm::vec3(0, 0, 1) : glm::normalize(-point.position);
  point.normal = sampler_.normalAt(primitive.material, attributes, hit->front, point.toEye);
  const glm::dvec3 flat =
      glm::normalize(glm::cross(corners.p[1] - corners.p[0], corners.p[2] - corners.p[0])) * (hit->front ? 1.0 : -1.0);
  point.flat = glm::vec3(flat);
  point.surface =
      sampler_.surfaceAt(primitive.material, attributes, placed.thicknessScale, hit->front, RimKind::hard, 0.0f);
  return seen;
}

void OpaqueRenderer::centre(int column, int row, const Seen& seen) {
  planes_.viewZ.at(column, row) = static_cast<float>(seen.z);
  planes_.normal.at(column, row) = glm::normalize(worldFromView_ * seen.point.normal);
  planes_.albedo.at(column, row) = seen.point.surface.baseColor;
  if (!planes_.occlusion.empty()) {
    const std::uint32_t seed = pixelSeed(planes_.window.x0 + column, planes_.window.y0 + row, kOpenness);
    planes_.occlusion.at(column, row) = lighting_.openness(seen.point, settings_.aoRadius, settings_.aoSamples, seed);
  }
}

void OpaqueRenderer::addColour(const Ray& ray, const std::optional<Seen>& seen, int x, int y, int sample,
                               Colour& sum) const {
  if (!seen) {
    if (environment_.black()) return;
    sum.behind += lighting_.background(glm::vec3(ray.direction));
    sum.alpha += 1.0f;
    return;
  }
  sum.alpha += 1.0f;
  if (seen->unlit) {
    sum.emission += seen->point.surface.baseColor;
    return;
  }
  sum.emission += seen->point.surface.emission;
  for (std::size_t i = 0; i < lights_.size(); ++i) sum.lights[i] += lighting_.direct(lights_[i], seen->point);
  if (environment_.black()) return;
  const auto first = static_cast<std::uint32_t>(sample * kDirectionsPerSample);
  sum.indirect += lighting_.surroundings(seen->point, kDirectionsPerSample, first, pixelSeed(x, y, kSurroundings));
}

void OpaqueRenderer::store(int column, int row, const Colour& sum) {
  const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(planes_.window.width()) +
                        static_cast<std::size_t>(column);
  const float share = 1.0f / static_cast<float>(settings_.samples);
  for (std::size_t k = 0; k < lights_.size(); ++k) planes_.lights[k].radiance[i] = sum.lights[k] * share;
  if (!planes_.indirect.empty()) planes_.indirect[i] = sum.indirect * share;
  if (!planes_.emission.empty()) planes_.emission[i] = sum.emission * share;
  sumBeauty(planes_, i, sum.behind * share, sum.alpha * share);
}

// The pixels of one packet of rays. Nothing that happens in another block shows here.
void OpaqueRenderer::block(int column0, int row0) {
  const int x0 = planes_.window.x0 + column0, y0 = planes_.window.y0 + row0;
  const int columns = std::min(kBlock, planes_.window.width() - column0);
  const int rows = std::min(kBlock, planes_.window.height() - row0);
  const auto inside = [&](int i) { return i % kBlock < columns && i / kBlock < rows; };
  Colour sums[16];
  for (Colour& sum : sums) sum.lights.assign(lights_.size(), glm::vec3(0.0f));
  BlockHits hits;
  std::array<glm::vec2, 16> where;
  for (int sample = settings_.samples == 1 ? 0 : -1; sample < settings_.samples; ++sample) {
    const bool atCentre = sample < 0 || settings_.samples == 1;
    for (int i = 0; i < 16; ++i)
      where[static_cast<std::size_t>(i)] =
          atCentre
              ? glm::vec2(0.5f)
              : places_.of(samplePoint(static_cast<std::uint32_t>(sample), pixelSeed(x0 + i % 4, y0 + i / 4, kPixel)));
    traced_.traceBlock(rays_, x0, y0, where, hits);
    for (int i = 0; i < 16; ++i) {
      if (!inside(i)) continue;
      const int x = x0 + i % kBlock, y = y0 + i / kBlock;
      const glm::vec2 at = where[static_cast<std::size_t>(i)];
      const Ray ray = rays_.through({x + static_cast<double>(at.x), y + static_cast<double>(at.y)});
      const std::optional<Seen> seen = look(ray, hits.instance[i], hits.triangle[i]);
      if (atCentre && seen) centre(x - planes_.window.x0, y - planes_.window.y0, *seen);
      if (sample >= 0) addColour(ray, seen, x, y, sample, sums[i]);
    }
  }
  for (int i = 0; i < 16; ++i)
    if (inside(i)) store(column0 + i % kBlock, row0 + i / kBlock, sums[i]);
}

OpaquePlanes OpaqueRenderer::render() {
  const int across = (planes_.window.width() + kBlock - 1) / kBlock;
  const int down = (planes_.window.height() + kBlock - 1) / kBlock;
  std::atomic<int> done{0};
  std::mutex reporting;
  tbb::parallel_for(0, down, [&](int row) {
    for (int column = 0; column < across; ++column) block(column * kBlock, row * kBlock);
    const int finished = ++done;
    if (!settings_.progress) return;
    const std::lock_guard lock(reporting);
    settings_.progress(static_cast<double>(finished) / static_cast<double>(down));
  });
  return std::move(planes_);
}

}  // namespace

OpaquePlanes renderOpaque(const Scene& scene, const Camera& camera, const Window& display, const Window& data,
                          const Environment& environment, const OpaqueRenderSettings& settings) {
  return OpaqueRenderer(scene, camera, display, data, environment, settings).render();
}

}  // namespace pellucid
