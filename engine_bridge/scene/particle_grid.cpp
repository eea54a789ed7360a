#include "engine_bridge/scene/particle_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine_bridge/scene/light_views.h"
#include "engine_bridge/scene/placed.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {
namespace {

constexpr double kDense = 16.0;  // particles over one another, of whose rims a map need not show each

struct Ball {
  glm::dvec3 middle;  // world
  double radius, coverage;
};
using Visit = std::function<void(const Ball&)>;

double meanAlpha(const Scene& scene, const Material& material) {
  if (material.baseColorTexture.texture < 0) return 1.0;
  const Image<glm::vec4>& texels = scene.textures[static_cast<std::size_t>(material.baseColorTexture.texture)].texels;
  double sum = 0.0;
  for (std::size_t i = 0; i < texels.size(); ++i) sum += static_cast<double>(texels[i].a);
  return texels.empty() ? 1.0 : sum / static_cast<double>(texels.size());
}

void eachPoint(const Instance& instance, const Primitive& primitive, const Material& material, const Visit& visit) {
  constexpr std::size_t kAtOnce = 1024;
  const double scale = uniformScale(instance.worldFromObject) * static_cast<double>(material.pointScale);
  const double alpha = static_cast<double>(material.baseColor.a * material.coverage.value_or(1.0f) * instance.colour.a);
  VertexPlaces places;
  TriangleBatch batch;
  for (std::size_t first = 0; first < primitive.triangles(); first += kAtOnce) {
    readTriangles(primitive, first, std::min(kAtOnce, primitive.triangles() - first), places, batch);
    for (std::size_t i = 0; i < batch.indices.size(); i += 3) {
      const Vertex& vertex = batch.vertices[batch.indices[i]];
      visit({glm::dvec3(instance.worldFromObject * glm::dvec4(vertex.position, 1.0)),
             scale * static_cast<double>(vertex.uv[1].x), alpha * static_cast<double>(vertex.colour.a)});
    }
  }
}

// A card stands for a ball of its own size.
void eachCard(const Scene& scene, const Instance& instance, const Primitive& primitive, const Material& material,
              const Visit& visit) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  VertexPlaces places;
  TriangleBatch batch;
  readTriangles(primitive, 0, std::min<std::size_t>(primitive.triangles(), 1024), places, batch);
  for (const Vertex& vertex : batch.vertices) {
    low = glm::min(low, glm::dvec3(vertex.position));
    high = glm::max(high, glm::dvec3(vertex.position));
  }
  const glm::dvec3 size = 0.5 * (high - low);
  const double scale = uniformScale(instance.worldFromObject);
  visit({glm::dvec3(instance.worldFromObject * glm::dvec4(0.5 * (low + high), 1.0)), scale * std::max(size.x, size.y),
         static_cast<double>(material.baseColor.a * material.coverage.value_or(1.0f) * instance.colour.a) *
             meanAlpha(scene, material)});
}

void eachBall(const Scene& scene, const Visit& visit) {
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    if (!material.castsShadow || material.additive || !material.transparent()) continue;
    const Visit kept = [&](const Ball& ball) {
      if (ball.radius > 0.0 && ball.coverage > 0.0 && std::isfinite(ball.middle.x + ball.middle.y + ball.middle.z))
        visit(ball);
    };
    if (primitive.points)
      eachPoint(instance, primitive, material, kept);
    else if (material.billboard)
      eachCard(scene, instance, primitive, material, kept);
  }
}

// Spreads the ball's mass, extinction times volume, by a tent that reaches half a cube beyond it.
void splat(const Ball& ball, const glm::dvec3& low, double edge, std::vector<double>& weights, Volume<float>& density) {
  const double thickest = -std::log1p(-std::min(ball.coverage, 0.999999));  // over the diameter
  const double mass = thickest / (2.0 * ball.radius) * (4.0 / 3.0 * 3.141592653589793) * std::pow(ball.radius, 3.0);
  const double reach = ball.radius + 0.5 * edge;
  const glm::dvec3 at = (ball.middle - low) / edge - 0.5;
  const double cells = reach / edge;
  const glm::ivec3 first = glm::max(glm::ivec3(glm::ceil(at - cells)), glm::ivec3(0));
  const glm::ivec3 last = glm::min(glm::ivec3(glm::floor(at + cells)), density.size - 1);
  weights.clear();
  double sum = 0.0;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const double distance = edge * glm::length(glm::dvec3(x, y, z) - at);
        // 1 inside, falling over one cube about the ball's surface.
        weights.push_back(std::clamp((reach - distance) / edge, 0.0, 1.0));
        sum += weights.back();
      }
  if (!(sum > 0.0)) {
    const glm::ivec3 nearest = glm::clamp(glm::ivec3(glm::round(at)), glm::ivec3(0), density.size - 1);
    density.at(nearest) += static_cast<float>(mass / (edge * edge * edge));
    return;
  }
  std::size_t next = 0;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x, ++next)
        if (weights[next] > 0.0)
          density.at({x, y, z}) += static_cast<float>(mass * weights[next] / (sum * edge * edge * edge));
}

}  // namespace

std::shared_ptr<const DensityGrid> particleGrid(const Scene& scene, int longest) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  eachBall(scene, [&](const Ball& ball) {
    low = glm::min(low, ball.middle - ball.radius);
    high = glm::max(high, ball.middle + ball.radius);
  });
  if (!(high.x > low.x)) return nullptr;
  const glm::dvec3 extent = high - low;
  const double edge = std::max({extent.x, extent.y, extent.z}) / longest;
  auto grid = std::make_shared<DensityGrid>();
  grid->density =
      Volume<float>(glm::clamp(glm::ivec3(glm::ceil(extent / edge - 1e-6)), glm::ivec3(1), glm::ivec3(longest)), 0.0f);
  for (int c = 0; c < 3; ++c) {
    const double size = edge * grid->density.size[c];
    grid->boxFromWorld[c][c] = 1.0 / size;
    grid->boxFromWorld[3][c] = -low[c] / size;
  }
  std::vector<double> weights;
  eachBall(scene, [&](const Ball& ball) { splat(ball, low, edge, weights, grid->density); });
  for (const float value : grid->density.texels) grid->most = std::max(grid->most, value);
  return grid;
}

int particleMapSize(const Scene& scene, int across, int most) {
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    if (castsInto(Casters::transparent, material) && !primitive.points && !material.billboard) return most;
  }
  Bounds bounds;
  double sum = 0.0, number = 0.0, discs = 0.0;
  eachBall(scene, [&](const Ball& ball) {
    bounds.add(ball.middle - ball.radius);
    bounds.add(ball.middle + ball.radius);
    sum += ball.radius;
    number += 1.0;
    discs += 3.141592653589793 * ball.radius * ball.radius;
  });
  if (!(sum > 0.0)) return most;
  const glm::dvec3 extent = bounds.high - bounds.low;
  const double area = std::max({extent.x * extent.y, extent.y * extent.z, extent.z * extent.x});
  if (discs < kDense * area) return most;
  const double texels = 0.5 * across * std::max({extent.x, extent.y, extent.z}) * number / sum;
  return static_cast<int>(
      std::min(std::ceil(std::clamp(texels, 512.0, 1e6) / 128.0) * 128.0, static_cast<double>(most)));
}

Fog particleFog(std::shared_ptr<const DensityGrid> grid, const Camera& camera,
                std::vector<shading::PunctualLight> lights) {
  MediumSettings medium;
  medium.density = 1.0;
  medium.grid = std::move(grid);
  return placeFog(medium, camera, {}, std::move(lights));
}

}  // namespace pellucid
