#include "engine_bridge/embree/ray_fragments.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/embree/surface_sampler.h"
#include "engine_bridge/embree/transparent_scene.h"
#include "gbuffer/errors.h"
#include "gbuffer/shadow_maps.h"
#include "shaders/mask.h"
#include "shaders/piece.h"

namespace pellucid {
namespace {

using namespace rays;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kFirstRows = 16;  // of a band; then as many as the budget seems to hold

struct Row {
  std::vector<std::uint32_t> counts;
  std::vector<Fragment> fragments;
  std::vector<glm::vec4> solid;
};

bool nearer(const Fragment& a, const Fragment& b) {
  return a.z != b.z ? a.z < b.z : a.identity < b.identity;
}

}  // namespace

struct RayFragments::Impl {
  const Scene& scene;
  const GBuffer& gbuffer;
  Camera camera;
  CameraRays rays;
  TransparentScene traced;
  std::vector<PunctualLight> lights;    // those that shine
  std::vector<std::size_t> lightIndex;  // of each in the scene
  std::shared_ptr<const ShadowRays> shadowRays;
  glm::mat3 worldFromView;

  Impl(const Scene& sceneGiven, const GBuffer& gbufferGiven, const Camera& cameraGiven)
      : scene(sceneGiven),
        gbuffer(gbufferGiven),
        camera(cameraGiven),
        rays(camera, gbuffer.display),
        traced(scene, camera),
        lights(lightBlocks(scene.lights, camera)),
        worldFromView(glm::transpose(glm::dmat3(camera.viewFromWorld))) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (shines(scene.lights[i])) lightIndex.push_back(i);
  }

  Ray rayOf(int x, int y, const PassSettings& settings) const {
    return rays.through({x + settings.sample.x, y + settings.sample.y});
  }
  std::uint32_t pieceAt(const Crossing& crossing, std::uint32_t identity, int x, int y) const;
  float alphaWidth(const Crossing& crossing, const Primitive& primitive, int x, int y, const SurfaceSampler& sampler,
                   const PassSettings& settings) const;
  std::optional<Fragment> shade(const Crossing& crossing, const Ray& ray, int x, int y, const SurfaceSampler& sampler,
                                const PassSettings& settings) const;
  void pixel(int column, int row, const SurfaceSampler& sampler, const PassSettings& settings,
             std::vector<Crossing>& crossings, Row& out) const;
};

// The width of a mask's rim as GL takes it, by differences between neighbours of the pixel's 2x2 quad, on the
// triangle's plane.
float RayFragments::Impl::alphaWidth(const Crossing& crossing, const Primitive& primitive, int x, int y,
                                     const SurfaceSampler& sampler, const PassSettings& settings) const {
  const Placed& placed = traced.placed(crossing.instance);
  const Corners corners = cornersOf(primitive, placed.viewFromObject, crossing.triangle);
  struct Here {
    float alpha = 0.0f;
    glm::vec2 texel{0.0f};
  };
  const auto at = [&](int atX, int atY) {
    const std::optional<TriangleHit> hit = intersectPlane(rayOf(atX, atY, settings), corners);
    if (!hit) return Here{};
    const Attributes attributes = attributesAt(primitive, placed, crossing.triangle, *hit);
    return Here{sampler.alphaAt(primitive.material, attributes), sampler.baseTexelAt(primitive.material, attributes)};
  };
  // Quads count from the corner of the data window.
  const int left = x - ((x - gbuffer.data.x0) & 1), top = y - ((y - gbuffer.data.y0) & 1);
  const Here left0 = at(left, y), right0 = at(left + 1, y), top0 = at(x, top), bottom0 = at(x, top + 1);
  const float fwidth = std::abs(right0.alpha - left0.alpha) + std::abs(bottom0.alpha - top0.alpha);
  const float texels =
      shading::texelsAcross(right0.texel - left0.texel, bottom0.texel - top0.texel, settings.footprint);
  const float width = settings.footprint * fwidth * shading::rimLeft(texels);
  return std::isfinite(width) ? width : kInfinity;
}

// Mirrors identityHere() of shaders/gl/piece.glsl.
std::uint32_t RayFragments::Impl::pieceAt(const Crossing& crossing, std::uint32_t identity, int x, int y) const {
  const Primitive& primitive = scene.primitives[static_cast<std::size_t>(scene.instances[crossing.instance].primitive)];
  const Corners corners = cornersOf(primitive, traced.placed(crossing.instance).viewFromObject, crossing.triangle);
  const auto shares = [&](double right, double down) {
    const std::optional<TriangleHit> hit = intersectPlane(rays.through({x + 0.5 + right, y + 0.5 + down}), corners);
    return hit ? glm::dvec2(hit->weight[1], hit->weight[2]) : glm::dvec2(0.0);
  };
  const glm::dvec2 at = shares(0.0, 0.0);
  const glm::vec2 right(shares(1.0, 0.0) - at), down(shares(0.0, 1.0) - at);
  return shading::pieceOf(identity, glm::vec2(at),
                          {glm::length(glm::vec2(right.x, down.x)), glm::length(glm::vec2(right.y, down.y))});
}

// Mirrors main() of shaders/gl/transparent.frag.
std::optional<Fragment> RayFragments::Impl::shade(const Crossing& crossing, const Ray& ray, int x, int y,
                                                  const SurfaceSampler& sampler, const PassSettings& settings) const {
  const Instance& instance = scene.instances[crossing.instance];
  const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
  const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
  const Placed& placed = traced.placed(crossing.instance);
  const Attributes attributes = attributesAt(primitive, placed, crossing.triangle, crossing.hit);
  const bool smooth = material.alphaMode == AlphaMode::mask && settings.mask == MaskEdge::smooth;
  const float width = smooth ? alphaWidth(crossing, primitive, x, y, sampler, settings) : 0.0f;
  const shading::Surface surface =
      sampler.surfaceAt(primitive.material, attributes, placed.thicknessScale, crossing.hit.front,
                        settings.mask == MaskEdge::smooth ? RimKind::smooth : RimKind::hard, width);
  if (!(surface.coverage > 0.0f)) return std::nullopt;

  const glm::vec3 position(ray.origin + crossing.hit.z * ray.direction);
  float cosEye = 1.0f;
  glm::vec3 reflected(0.0f);
  if (material.unlit) {
    reflected = surface.baseColor;
  } else {
    const glm::vec3 toEye = rays.orthographic() ? glm::vec3(0, 0, 1) : glm::normalize(-position);
    const glm::vec3 normal = sampler.normalAt(primitive.material, attributes, crossing.hit.front, toEye);
    cosEye = std::clamp(glm::dot(normal, toEye), shading::PLD_GRAZING, 1.0f);
    if (settings.environment)
      reflected = settings.environment->reflected(surface, worldFromView * normal, worldFromView * toEye, cosEye);
    else
      reflected = shading::reflectSurroundings(surface, cosEye) * settings.surroundings;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      shading::Arriving arriving = shading::arrivingAt(lights[i], position);
      if (shadowRays)
        arriving.irradiance *= shadowRays->visibilityFrom(shading::identityOf(instance.identity, crossing.triangle),
                                                          lightIndex[i], glm::dvec3(position));
      else if (settings.shadowRays)
        arriving.irradiance *=
            (*settings.shadowRays)(i, glm::dvec3(position), shading::identityOf(instance.identity, crossing.triangle));
      else if (settings.shadows)
        arriving.irradiance *= settings.shadows->visibility(lightIndex[i], position);
      reflected += shading::reflectTowardsEye(surface, normal, toEye, arriving.toLight) * arriving.irradiance;
    }
  }
  const shading::Layer layer =
      shading::layerOf(surface, reflected, cosEye, static_cast<float>(crossing.hit.z), material.additive);
  Fragment fragment{};
  fragment.radiance = glm::min(layer.radiance, glm::vec3(shading::PLD_BRIGHTEST));
  fragment.coverage = layer.coverage;
  fragment.transmission = layer.transmission;
  fragment.z = layer.z;
  fragment.identity = shading::identityOf(instance.identity, crossing.triangle);
  if (settings.pieces) fragment.identity = pieceAt(crossing, fragment.identity, x, y);
  return fragment;
}

void RayFragments::Impl::pixel(int column, int row, const SurfaceSampler& sampler, const PassSettings& settings,
                               std::vector<Crossing>& crossings, Row& out) const {
  const int x = gbuffer.data.x0 + column, y = gbuffer.data.y0 + row;
  const Ray ray = rayOf(x, y, settings);
  const float limit = gbuffer.viewZ.at(column, row) * (1.0f + gbuffer.depthPrecision);
  crossings.clear();
  traced.cross(ray, limit, crossings);
  const std::size_t first = out.fragments.size();
  glm::vec4 solid(0, 0, 0, kInfinity);
  for (const Crossing& crossing : crossings) {
    if (static_cast<float>(crossing.hit.z) > limit) continue;
    const std::optional<Fragment> fragment = shade(crossing, ray, x, y, sampler, settings);
    if (!fragment) continue;
    if (!shading::isSolid(fragment->coverage, fragment->transmission)) {
      out.fragments.push_back(*fragment);
    } else if (fragment->z < solid.a) {
      solid = glm::vec4(fragment->radiance, fragment->z);
    } else if (fragment->z == solid.a) {
      // At the same depth the larger radiance of each channel: no order shows.
      solid = glm::vec4(glm::max(glm::vec3(solid), fragment->radiance), solid.a);
    }
  }
  const auto begin = out.fragments.begin() + static_cast<std::ptrdiff_t>(first);
  out.fragments.erase(
      std::remove_if(begin, out.fragments.end(), [&](const Fragment& fragment) { return fragment.z > solid.a; }),
      out.fragments.end());
  std::sort(out.fragments.begin() + static_cast<std::ptrdiff_t>(first), out.fragments.end(), nearer);
  out.counts.push_back(static_cast<std::uint32_t>(out.fragments.size() - first));
  out.solid.push_back(solid);
}

RayFragments::RayFragments(const Scene& scene, const GBuffer& gbuffer, const Camera& camera)
    : impl_(new Impl(scene, gbuffer, camera)) {}
RayFragments::~RayFragments() = default;

void RayFragments::shadowBy(std::shared_ptr<const ShadowRays> rays) {
  impl_->shadowRays = std::move(rays);
}

void RayFragments::fragments(const PassSettings& settings, const std::function<void(const FragmentLists&)>& band) {
  if (settings.filter == TextureFilter::mipmap)
    throw UsageError("--texture-filter: found mipmap, expected bilinear or nearest: fragments by rays read level 0");
  const SurfaceSampler sampler(
      impl_->scene, settings.filter == TextureFilter::nearest ? TexelFilter::nearest : TexelFilter::bilinear);
  const Window& data = impl_->gbuffer.data;
  int rows = kFirstRows;
  for (int top = 0; top < data.height();) {
    rows = std::min(rows, data.height() - top);
    std::vector<Row> done(static_cast<std::size_t>(rows));
    tbb::parallel_for(0, rows, [&](int i) {
      std::vector<Crossing> crossings;
      Row& row = done[static_cast<std::size_t>(i)];
      for (int x = 0; x < data.width(); ++x) impl_->pixel(x, top + i, sampler, settings, crossings, row);
    });
    FragmentLists lists;
    lists.window = {data.x0, data.y0 + top, data.x1, data.y0 + top + rows};
    lists.offsets.assign(1, 0);
    lists.solid = Image<glm::vec4>(data.width(), rows);
    for (int i = 0; i < rows; ++i) {
      const Row& row = done[static_cast<std::size_t>(i)];
      for (const std::uint32_t count : row.counts) lists.offsets.push_back(lists.offsets.back() + count);
      lists.fragments.insert(lists.fragments.end(), row.fragments.begin(), row.fragments.end());
      std::copy(row.solid.begin(), row.solid.end(), lists.solid.row(i));
    }
    band(lists);
    top += rows;
    // Rows and lists hold each fragment once, for a moment together.
    const std::size_t each = 2 * lists.fragments.size() * sizeof(Fragment) / static_cast<std::size_t>(rows) +
                             64 * lists.solid.size() / static_cast<std::size_t>(rows);
    rows = static_cast<int>(std::clamp<std::size_t>(settings.budgetBytes / std::max<std::size_t>(each, 1), 1, 256));
  }
}

}  // namespace pellucid
