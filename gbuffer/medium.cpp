#include "gbuffer/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace pellucid {
namespace {

glm::dmat4 boxFromWorld(const Box& box) {
  const glm::dvec3 size = box.high - box.low;
  glm::dmat4 matrix(1.0);
  for (int c = 0; c < 3; ++c) {
    matrix[c][c] = 1.0 / size[c];
    matrix[3][c] = -box.low[c] / size[c];
  }
  return matrix;
}

bool inOrder(const Box& box) {
  return box.high.x > box.low.x && box.high.y > box.low.y && box.high.z > box.low.z;
}

}  // namespace

Fog placeFog(const MediumSettings& settings, const Camera& camera, const AmbientLight& ambient,
             std::vector<shading::PunctualLight> lights) {
  if (!(settings.density >= 0.0) || !(settings.height >= 0.0) || !(std::abs(settings.g) <= 0.98) ||
      settings.steps < 1 || !(settings.collimation >= 0.0 && settings.collimation <= 1.0) ||
      (settings.farthest && !(*settings.farthest > 0.0)) || (settings.box && !inOrder(*settings.box)) ||
      (settings.emission != glm::dvec3(0.0) && !(settings.density > 0.0)))
    throw std::logic_error("placeFog: a setting is out of its range");
  const glm::dmat3 turn(camera.viewFromWorld);
  const glm::dmat4 worldFromView = glm::inverse(camera.viewFromWorld);
  Fog fog;
  fog.camera = camera;
  shading::Medium& medium = fog.medium;
  medium.scattering = glm::vec4(glm::vec3(settings.albedo), static_cast<float>(settings.g));
  const bool bounded = settings.grid || settings.box;
  medium.extinction = {static_cast<float>(settings.density),
                       settings.height > 0.0 && !settings.grid ? static_cast<float>(1.0 / settings.height) : 0.0f,
                       bounded ? 1.0f : 0.0f, settings.grid ? 1.0f : 0.0f};
  medium.march = {static_cast<float>(settings.farthest.value_or(kFogBeforeNothing)), static_cast<float>(settings.steps),
                  static_cast<float>(1.0 - settings.collimation), settings.farthest ? 0.0f : 1.0f};
  const glm::dvec3 eye(worldFromView[3]);
  medium.up = glm::vec4(glm::vec3(turn * glm::dvec3(0.0, 1.0, 0.0)), static_cast<float>(eye.y - settings.base));
  medium.ambient = glm::vec4(ambient.mean, 0.0f);
  glm::vec4* slopes[] = {&medium.ambientRed, &medium.ambientGreen, &medium.ambientBlue};
  for (int c = 0; c < 3; ++c) *slopes[c] = glm::vec4(glm::vec3(turn * ambient.slope[c]), 0.0f);
  const glm::dmat4 box = settings.grid  ? settings.grid->boxFromWorld
                         : settings.box ? boxFromWorld(*settings.box)
                                        : glm::dmat4(1.0);
  medium.boxFromView = glm::mat4(box * worldFromView);
  const glm::dvec3 glow = settings.density > 0.0 ? settings.emission / settings.density : glm::dvec3(0.0);
  medium.glow = glm::vec4(glm::vec3(glow), settings.grid && !settings.grid->emission.texels.empty() ? 1.0f : 0.0f);
  fog.order = settings.order;
  fog.lights = std::move(lights);
  fog.grid = settings.grid;
  return fog;
}

namespace {

struct Bounds {
  Box box{glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(-std::numeric_limits<double>::infinity())};
  void add(const glm::dvec3& point) {
    box.low = glm::min(box.low, point);
    box.high = glm::max(box.high, point);
  }
};

Box boxOfGrid(const DensityGrid& grid) {
  const glm::dmat4 worldFromBox = glm::inverse(grid.boxFromWorld);
  Bounds bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.add(glm::dvec3(worldFromBox * glm::dvec4(corner & 1, (corner >> 1) & 1, corner >> 2, 1.0)));
  return bounds.box;
}

// How far what reaches the fog is sampled: all of the way to surfaces, but not to a backdrop many times as far away as
// they are, before which a fixed number of texels would be too few for what stands near.
float lightReach(const MediumSettings& settings, const Image<float>& viewZ) {
  constexpr float kBackdrop = 16.0f;  // times the depth than which a quarter of the surfaces are nearer
  std::vector<float> surfaces;
  for (std::size_t i = 0; i < viewZ.size(); ++i)
    if (std::isfinite(viewZ[i])) surfaces.push_back(viewZ[i]);
  auto limit = static_cast<float>(settings.farthest.value_or(kFogBeforeNothing));
  if (surfaces.empty()) return limit;
  const float farthest = *std::max_element(surfaces.begin(), surfaces.end());
  if (!settings.farthest && farthest > limit) {
    const auto quarter = surfaces.begin() + static_cast<std::ptrdiff_t>(surfaces.size() / 4);
    std::nth_element(surfaces.begin(), quarter, surfaces.end());
    limit = std::max(limit, kBackdrop * *quarter);
  }
  return std::min(farthest, limit);
}

}  // namespace

Box fogBounds(const MediumSettings& settings, const Camera& camera, const GBuffer& gbuffer) {
  if (settings.grid) return boxOfGrid(*settings.grid);
  const float farthest = lightReach(settings, gbuffer.viewZ);
  const PixelRays rays = pixelRays(camera, gbuffer.display, {gbuffer.data.x0, gbuffer.data.y0}, {0.5, 0.5});
  const glm::dmat4 worldFromView = glm::inverse(camera.viewFromWorld);
  Bounds bounds;
  for (int y = 0; y < gbuffer.viewZ.height(); ++y)
    for (int x = 0; x < gbuffer.viewZ.width(); ++x) {
      const double z = static_cast<double>(std::min(gbuffer.viewZ.at(x, y), farthest));
      const glm::dvec2 at(rays.offset + rays.scale * glm::vec2(static_cast<float>(x), static_cast<float>(y)));
      const glm::dvec2 start = camera.orthographic ? at : glm::dvec2(0.0), end = camera.orthographic ? at : at * z;
      bounds.add(glm::dvec3(worldFromView * glm::dvec4(start, 0.0, 1.0)));
      bounds.add(glm::dvec3(worldFromView * glm::dvec4(end, -z, 1.0)));
    }
  if (settings.box) {
    const Box both{glm::max(bounds.box.low, settings.box->low), glm::min(bounds.box.high, settings.box->high)};
    return inOrder(both) ? both : *settings.box;
  }
  return bounds.box;
}

PixelRays pixelRays(const Camera& camera, const Window& display, glm::ivec2 first, glm::dvec2 sample) {
  // NDC is focal * (x, y) / z + centre.
  const glm::dvec2 size(display.width(), display.height());
  const glm::dvec2 from = glm::dvec2(first - glm::ivec2(display.x0, display.y0)) + sample;
  const glm::dvec2 flip(1.0, -1.0);
  const glm::dvec2 ndcOffset = flip * (2.0 * from / size - 1.0), ndcScale = flip * 2.0 / size;
  PixelRays rays;
  rays.offset = glm::vec2((ndcOffset - camera.centre) / camera.focal);
  rays.scale = glm::vec2(ndcScale / camera.focal);
  rays.orthographic = camera.orthographic;
  return rays;
}

}  // namespace pellucid
