#include "engine_bridge/embree/point_lighting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/embree/sampling.h"

namespace pellucid::rays {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Rays start this far off the surface, relative to its distance: some hundred units in the last place of a position.
constexpr float kLift = 8e-6f;

// Directions by how much the surface reflects from them: the cosine for its diffuse part, GGX for its highlight.
class SurfaceDirections {
 public:
  explicit SurfaceDirections(const ShadePoint& point) : point_(point), frame_(point.normal) {
    const float cosEye = std::clamp(glm::dot(point.normal, point.toEye), shading::PLD_GRAZING, 1.0f);
    const float specular = shading::meanOf(shading::specularReflectance(point.surface, cosEye));
    const float diffuse = shading::meanOf(shading::diffuseAlbedo(point.surface, cosEye));
    const float sum = specular + diffuse;
    highlight_ = sum > 0.0f ? specular / sum : 0.0f;
    // Neither part is starved while it is there: its light would be rare and bright.
    if (specular > 0.0f && diffuse > 0.0f) highlight_ = std::clamp(highlight_, 0.1f, 0.9f);
    const float roughness = std::max(point.surface.roughness, shading::PLD_MIN_ROUGHNESS);
    const float a = roughness * roughness;
    a2_ = a * a;
  }

  glm::vec3 choose(glm::vec2 random) const {
    if (random.x >= highlight_)
      return frame_.from(cosineDirection({(random.x - highlight_) / (1.0f - highlight_), random.y}));
    const float u = random.x / highlight_, angle = 2.0f * shading::PLD_PI * random.y;
    const float cos2 = (1.0f - u) / (1.0f + (a2_ - 1.0f) * u);
    const float cosine = std::sqrt(cos2), sine = std::sqrt(std::max(1.0f - cos2, 0.0f));
    const glm::vec3 half = frame_.from({sine * std::cos(angle), sine * std::sin(angle), cosine});
    return 2.0f * glm::dot(point_.toEye, half) * half - point_.toEye;
  }

  float density(glm::vec3 towards) const {
    const float cosine = glm::dot(point_.normal, towards);
    if (cosine <= 0.0f) return 0.0f;
    float result = (1.0f - highlight_) * cosine / shading::PLD_PI;
    if (highlight_ > 0.0f) {
      const glm::vec3 half = glm::normalize(towards + point_.toEye);
      const float cosHalf = std::clamp(glm::dot(point_.normal, half), 0.0f, 1.0f);
      const float across = std::max(glm::dot(towards, half), 1e-6f);
      const float facets = shading::ggxDensity(shading::sineSquaredBetween(point_.normal, half), a2_);
      result += highlight_ * facets * cosHalf / (4.0f * across);
    }
    return result;
  }

 private:
  const ShadePoint& point_;
  Frame frame_;
  float highlight_, a2_;
};

}  // namespace

Lighting::Lighting(const OpaqueScene& scene, const Environment& environment, const Camera& camera, bool shadows)
    : scene_(scene),
      environment_(environment),
      worldFromView_(glm::transpose(glm::dmat3(camera.viewFromWorld))),
      viewFromWorld_(glm::dmat3(camera.viewFromWorld)),
      shadows_(shadows) {}

bool Lighting::blocked(const ShadePoint& point, glm::vec3 direction, float reach) const {
  const glm::vec3 size = glm::abs(point.position);
  const float lift = kLift * std::max({size.x, size.y, size.z});
  return scene_.blocked(point.position + lift * point.flat, direction, reach);
}

glm::vec3 Lighting::direct(const PunctualLight& light, const ShadePoint& point) const {
  const shading::Arriving arriving = shading::arrivingAt(light, point.position);
  const glm::vec3 added =
      shading::reflectTowardsEye(point.surface, point.normal, point.toEye, arriving.toLight) * arriving.irradiance;
  if (added == glm::vec3(0.0f) || !shadows_) return added;
  const bool directional = light.direction.w == 0.0f;
  const float reach =
      directional ? kInfinity : glm::length(glm::vec3(light.position) - point.position) * (1.0f - 1e-5f);
  return blocked(point, arriving.toLight, reach) ? glm::vec3(0.0f) : added;
}

glm::vec3 Lighting::oneDirection(const ShadePoint& point, glm::vec3 towards, float density) const {
  if (!(density > 0.0f)) return glm::vec3(0.0f);
  const glm::vec3 reflected = shading::reflectTowardsEye(point.surface, point.normal, point.toEye, towards);
  const glm::vec3 arriving = environment_.radiance(glm::normalize(worldFromView_ * towards));
  const glm::vec3 added = reflected * arriving / density;
  if (added == glm::vec3(0.0f)) return added;
  return shadows_ && blocked(point, towards, kInfinity) ? glm::vec3(0.0f) : added;
}

glm::vec3 Lighting::surroundings(const ShadePoint& point, int samples, std::uint32_t firstSample,
                                 std::uint32_t seed) const {
  if (environment_.black()) return glm::vec3(0.0f);
  if (environment_.constant() && !shadows_) {
    const float cosEye = std::clamp(glm::dot(point.normal, point.toEye), shading::PLD_GRAZING, 1.0f);
    return shading::reflectSurroundings(point.surface, cosEye) * environment_.radiance(glm::vec3(0, 1, 0));
  }
  const SurfaceDirections directions(point);
  const bool chooseByMap = !environment_.constant();
  glm::vec3 sum(0.0f);
  for (int i = 0; i < samples; ++i) {
    const std::uint32_t index = firstSample + static_cast<std::uint32_t>(i);
    const glm::vec3 bySurface = directions.choose(samplePoint(index, seed));
    float density = directions.density(bySurface);
    if (chooseByMap) density += environment_.density(glm::normalize(worldFromView_ * bySurface));
    sum += oneDirection(point, bySurface, density);
    if (!chooseByMap) continue;
    const Environment::Chosen chosen = environment_.choose(samplePoint(index, ~seed));
    const glm::vec3 byMap = viewFromWorld_ * chosen.towards;
    if (chosen.density > 0.0f) sum += oneDirection(point, byMap, chosen.density + directions.density(byMap));
  }
  return sum / static_cast<float>(samples);
}

float Lighting::openness(const ShadePoint& point, float radius, int samples, std::uint32_t seed) const {
  const Frame frame(point.normal);
  int open = 0;
  for (int i = 0; i < samples; ++i) {
    const glm::vec3 towards = frame.from(cosineDirection(samplePoint(static_cast<std::uint32_t>(i), seed)));
    open += blocked(point, towards, radius) ? 0 : 1;
  }
  return static_cast<float>(open) / static_cast<float>(samples);
}

glm::vec3 Lighting::background(glm::vec3 directionView) const {
  return environment_.radiance(glm::normalize(worldFromView_ * directionView));
}

}  // namespace pellucid::rays
