#include "engine_bridge/embree/shadow_rays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine_bridge/embree/sampling.h"
#include "engine_bridge/embree/surface_sampler.h"
#include "engine_bridge/embree/transparent_scene.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {
namespace {

using namespace rays;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A point known by a float depth is off by some units in its last place.
constexpr double kLift = 8e-6;

}  // namespace

struct ShadowRays::Impl {
  const Scene& scene;
  Camera camera;
  TransparentScene traced;
  SurfaceSampler sampler;
  std::vector<PunctualLight> lights;
  std::vector<float> eta;  // by material

  bool opaque;  // ShadowRays::Casters::opaque

  Impl(const Scene& sceneGiven, const Camera& cameraGiven, bool opaqueGiven)
      : scene(sceneGiven),
        camera(cameraGiven),
        traced(scene, camera),
        sampler(scene, TexelFilter::bilinear),
        opaque(opaqueGiven) {
    for (const Light& light : scene.lights) lights.push_back(lightBlock(light, camera));
    for (const Material& material : scene.materials) eta.push_back(materialBlock(material).scattering.z);
  }
  glm::vec3 density(const Crossing& crossing, const glm::vec3& toLight) const;
  glm::vec3 visibility(std::size_t light, const glm::dvec3& point, std::vector<Crossing>& crossings,
                       std::optional<std::uint32_t> from = std::nullopt) const;
};

glm::vec3 ShadowRays::Impl::density(const Crossing& crossing, const glm::vec3& toLight) const {
  const Instance& instance = scene.instances[crossing.instance];
  const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
  const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
  const Placed& placed = traced.placed(crossing.instance);
  const Attributes attributes = attributesAt(primitive, placed, crossing.triangle, crossing.hit);
  const bool towardsLight = !crossing.hit.front;  // the ray looks from the receiver
  const shading::Surface surface =
      sampler.surfaceAt(primitive.material, attributes, placed.thicknessScale, towardsLight, RimKind::hard, 0.0f);
  if (material.additive || !(surface.coverage > 0.0f)) return glm::vec3(0.0f);
  if (opaque) return glm::vec3(surface.coverage >= 0.5f ? 1.0f : 0.0f);
  const glm::vec3 normal = shading::normalTowardsEye(attributes.normal, towardsLight, toLight);
  const float cosine = std::clamp(std::abs(glm::dot(normal, toLight)), shading::PLD_GRAZING, 1.0f);
  const glm::vec3 t = shading::transmissionAt(surface, cosine);
  return shading::shadowDensity(shading::opacityOf(surface.coverage, t), cosine,
                                eta[static_cast<std::size_t>(primitive.material)]);
}

glm::vec3 ShadowRays::Impl::visibility(std::size_t light, const glm::dvec3& point, std::vector<Crossing>& crossings,
                                       std::optional<std::uint32_t> from) const {
  const PunctualLight& block = lights[light];
  const shading::Arriving arriving = shading::arrivingAt(block, glm::vec3(point));
  if (arriving.irradiance == glm::vec3(0.0f)) return glm::vec3(1.0f);
  const bool directional = block.direction.w == 0.0f;
  const glm::dvec3 path = directional ? glm::dvec3(arriving.toLight) : glm::dvec3(glm::vec3(block.position)) - point;
  const double metres = directional ? 1.0 : glm::length(path);
  const glm::dvec3 size = glm::abs(point);
  const double lift = kLift * std::max({size.x, size.y, size.z}) / metres;
  crossings.clear();
  traced.crossAny(point + lift * path, path, directional ? kInfinity : 1.0 - lift, crossings);
  if (from)
    std::erase_if(crossings, [&](const Crossing& crossing) {
      return shading::identityOf(scene.instances[crossing.instance].identity, crossing.triangle) == *from;
    });
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
  });
  glm::dvec3 passed(1.0);
  for (std::size_t begin = 0; begin < crossings.size();) {
    std::size_t end = begin;
    bool faced = false;
    for (; end < crossings.size() && crossings[end].instance == crossings[begin].instance; ++end)
      faced = faced || !crossings[end].hit.front;
    const Instance& instance = scene.instances[crossings[begin].instance];
    const Material& material = scene.materials[static_cast<std::size_t>(
        scene.primitives[static_cast<std::size_t>(instance.primitive)].material)];
    for (; begin < end; ++begin) {
      const bool turned = crossings[begin].hit.front && faced && !material.bothSides();
      if (material.castsShadow && !turned)
        passed *= glm::dvec3(1.0) - glm::dvec3(density(crossings[begin], arriving.toLight));
    }
  }
  return glm::vec3(passed);
}

ShadowRays::ShadowRays(const Scene& scene, const Camera& camera, Casters casters)
    : impl_(new Impl(scene, camera, casters == Casters::opaque)) {}
ShadowRays::~ShadowRays() = default;

glm::vec3 ShadowRays::visibility(std::size_t light, const glm::dvec3& point) const {
  std::vector<Crossing> crossings;
  return impl_->visibility(light, point, crossings);
}

glm::vec3 ShadowRays::visibilityFrom(std::uint32_t identity, std::size_t light, const glm::dvec3& point) const {
  thread_local std::vector<Crossing> crossings;
  return impl_->visibility(light, point, crossings, identity);
}

Image<glm::vec3> ShadowRays::visibility(std::size_t light, const GBuffer& gbuffer, int samples,
                                        const AirPassed& air) const {
  const Image<float>& viewZ = gbuffer.viewZ;
  Image<glm::vec3> result(viewZ.width(), viewZ.height(), glm::vec3(1.0f));
  const CameraRays rays(impl_->camera, gbuffer.display);
  const DepthPlanes planes(gbuffer, impl_->camera);
  tbb::parallel_for(0, viewZ.height(), [&](int y) {
    std::vector<Crossing> crossings;
    for (int x = 0; x < viewZ.width(); ++x) {
      const float z = viewZ.at(x, y);
      if (!std::isfinite(z)) continue;
      const DepthPlane plane = planes.at(x, y);
      const glm::dvec2 centre(gbuffer.data.x0 + x + 0.5, gbuffer.data.y0 + y + 0.5);
      glm::dvec3 sum(0.0);
      for (int i = 0; i < samples; ++i) {
        glm::dvec2 offset(0.0);
        // One set of positions for all pixels: a straight edge then has one look along its length.
        if (samples > 1) offset = glm::dvec2(samplePoint(static_cast<std::uint32_t>(i), 0)) - 0.5;
        const double depth = plane.z(offset.x, offset.y);
        const bool left = !std::isfinite(depth);  // the plane has left the picture
        const Ray ray = rays.through(centre + (left ? glm::dvec2(0.0) : offset));
        const glm::dvec3 point = ray.origin + (left ? static_cast<double>(z) : depth) * ray.direction;
        const glm::vec3 passed = impl_->visibility(light, point, crossings);
        sum += glm::dvec3(air ? passed * air(point) : passed);
      }
      result.at(x, y) = glm::vec3(sum / static_cast<double>(samples));
    }
  });
  return result;
}

}  // namespace pellucid
