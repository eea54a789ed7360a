#include "tests/occlusion/leaf_world.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "engine_bridge/scene/foliage.h"
#include "samples/generate/hash.h"
#include "shaders/shading.h"

namespace pellucid::test {
namespace {

using samples::Card;

constexpr float kCutoff = 0.5f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Mask {
  std::vector<Image<glm::vec4>> levels;  // empty: solid

  static float bilinear(const Image<glm::vec4>& level, double u, double v) {
    const double x = u * level.width() - 0.5, y = v * level.height() - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto at = [&](int i, int j) {
      return static_cast<double>(level.at(std::clamp(i, 0, level.width() - 1), std::clamp(j, 0, level.height() - 1)).a);
    };
    const double s = x - x0, t = y - y0;
    return static_cast<float>((at(x0, y0) * (1 - s) + at(x0 + 1, y0) * s) * (1 - t) +
                              (at(x0, y0 + 1) * (1 - s) + at(x0 + 1, y0 + 1) * s) * t);
  }
  float finest(double u, double v) const { return levels.empty() ? 1.0f : bilinear(levels[0], u, v); }
  float trilinear(double u, double v, double lod) const {
    if (levels.empty()) return 1.0f;
    const double level = std::clamp(lod, 0.0, static_cast<double>(levels.size() - 1));
    const auto low = static_cast<std::size_t>(level);
    const float a = bilinear(levels[low], u, v), b = bilinear(levels[std::min(low + 1, levels.size() - 1)], u, v);
    return a + (b - a) * static_cast<float>(level - static_cast<double>(low));
  }
};

}  // namespace

struct LeafWorld::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  std::vector<Mask> masks;
  std::vector<std::pair<Card, std::size_t>> cards;  // and their masks; card i has triangles 2 i and 2 i + 1
  double scale = 1.0;

  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  // Where on its card a triangle was hit, v downwards as textures count.
  static glm::dvec2 uvOf(unsigned primitive, double u, double v) {
    // Triangles (0,1,2) and (0,2,3) of corners (0,0) (1,0) (1,1) (0,1).
    const glm::dvec2 on = primitive % 2 == 0 ? glm::dvec2(u + v, v) : glm::dvec2(u, u + v);
    return {on.x, 1.0 - on.y};
  }

  static void cutOut(const RTCFilterFunctionNArguments* arguments) {
    const auto* impl = static_cast<const Impl*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] != -1) continue;
      const unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, i);
      const glm::dvec2 uv = uvOf(primitive, static_cast<double>(RTCHitN_u(arguments->hit, arguments->N, i)),
                                 static_cast<double>(RTCHitN_v(arguments->hit, arguments->N, i)));
      const Mask& mask = impl->masks[impl->cards[primitive / 2].second];
      if (mask.finest(uv.x, uv.y) < kCutoff) arguments->valid[i] = 0;
    }
  }

  // Where on a card's plane a ray hits it; nothing when parallel.
  static glm::dvec2 onCard(const Card& card, glm::dvec3 origin, glm::dvec3 direction, double& distance) {
    const glm::dvec3 normal = glm::cross(card.right, card.up);
    distance = glm::dot(card.corner - origin, normal) / glm::dot(direction, normal);
    const glm::dvec3 at = origin + distance * direction - card.corner;
    const double rr = glm::dot(card.right, card.right), uu = glm::dot(card.up, card.up);
    return {glm::dot(at, card.right) / rr, 1.0 - glm::dot(at, card.up) / uu};  // cards are rectangles
  }
};

LeafWorld::LeafWorld(std::vector<Group> groups, double scale) : impl_(new Impl) {
  impl_->scale = scale;
  for (Group& group : groups) {
    Mask mask;
    if (!group.mask.empty()) mask.levels = coveragePreservingMips(group.mask, kCutoff);
    impl_->masks.push_back(std::move(mask));
    for (const Card& card : group.cards)
      impl_->cards.push_back({{card.corner * scale, card.right * scale, card.up * scale}, impl_->masks.size() - 1});
  }
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 4 * impl_->cards.size()));
  auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   sizeof(glm::uvec3), 2 * impl_->cards.size()));
  for (std::size_t i = 0; i < impl_->cards.size(); ++i) {
    const Card& card = impl_->cards[i].first;
    positions[4 * i] = glm::vec3(card.corner);
    positions[4 * i + 1] = glm::vec3(card.corner + card.right);
    positions[4 * i + 2] = glm::vec3(card.corner + card.right + card.up);
    positions[4 * i + 3] = glm::vec3(card.corner + card.up);
    const auto first = static_cast<unsigned>(4 * i);
    indices[2 * i] = {first, first + 1, first + 2};
    indices[2 * i + 1] = {first, first + 2, first + 3};
  }
  rtcSetGeometryUserData(geometry, impl_.get());
  rtcSetGeometryOccludedFilterFunction(geometry, Impl::cutOut);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);
}

LeafWorld::~LeafWorld() = default;

double LeafWorld::open(glm::dvec3 point, glm::dvec3 normal, double reach, int rays, std::uint32_t seed) const {
  const glm::dvec3 helper = std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
  const int edge = static_cast<int>(std::lround(std::sqrt(rays)));
  int hidden = 0;
  for (int i = 0; i < edge * edge; ++i) {
    const auto k = static_cast<std::uint32_t>(i);
    const double a = (i % edge + samples::unit(samples::hash(seed, k, 0))) / edge,
                 b = (i / edge + samples::unit(samples::hash(seed, k, 1))) / edge;
    const double radius = std::sqrt(a), angle = 2.0 * glm::pi<double>() * b;
    const glm::dvec3 to =
        radius * std::cos(angle) * x + radius * std::sin(angle) * y + std::sqrt(std::max(0.0, 1.0 - a)) * normal;
    const glm::dvec3 from = point + normal * (1e-4 * impl_->scale);
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x), ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(to.x), ray.dir_y = static_cast<float>(to.y), ray.dir_z = static_cast<float>(to.z);
    ray.tfar = static_cast<float>(reach);
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->scene, &context, &ray);
    hidden += ray.tfar < 0.0f;
  }
  return 1.0 - static_cast<double>(hidden) / (edge * edge);
}

Image<float> LeafWorld::coverage(const LeafView& view, int edge) const {
  const Window data = view.data.width() > 0 ? view.data : Window{0, 0, view.width, view.height};
  const double tall = std::tan(0.5 * view.yfov), wide = tall * view.width / view.height;
  const glm::dmat3 worldFromView =
      glm::transpose(glm::dmat3(glm::lookAt(view.eye * impl_->scale, view.target * impl_->scale, glm::dvec3(0, 1, 0))));
  const glm::vec3 eye(view.eye * impl_->scale);
  Image<float> covered(data.width(), data.height(), 0.0f);
  tbb::parallel_for(0, data.height(), [&](int y) {
    for (int x = 0; x < data.width(); ++x) {
      int hits = 0;
      for (int i = 0; i < edge * edge; ++i) {
        // Stratified: a regular grid would round what upright edges cover.
        const auto seed = static_cast<std::uint32_t>(y * data.width() + x), k = static_cast<std::uint32_t>(i);
        const double px = data.x0 + x + (i % edge + samples::unit(samples::hash(seed, k, 2))) / edge,
                     py = data.y0 + y + (i / edge + samples::unit(samples::hash(seed, k, 3))) / edge;
        const glm::dvec3 d = worldFromView * glm::dvec3((2.0 * px / view.width - 1.0) * wide,
                                                        (1.0 - 2.0 * py / view.height) * tall, -1.0);
        RTCRay ray{};
        ray.org_x = eye.x, ray.org_y = eye.y, ray.org_z = eye.z;
        ray.dir_x = static_cast<float>(d.x), ray.dir_y = static_cast<float>(d.y), ray.dir_z = static_cast<float>(d.z);
        ray.tfar = kInfinity;
        ray.mask = ~0u;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(impl_->scene, &context, &ray);
        hits += ray.tfar < 0.0f;
      }
      covered.at(x, y) = static_cast<float>(hits) / static_cast<float>(edge * edge);
    }
  });
  return covered;
}

LeafPicture LeafWorld::picture(const LeafView& view) const {
  LeafPicture out;
  out.display = {0, 0, view.width, view.height};
  out.data = view.data.width() > 0 ? view.data : out.display;
  const int width = out.data.width(), height = out.data.height();
  out.camera.viewFromWorld = glm::lookAt(view.eye * impl_->scale, view.target * impl_->scale, glm::dvec3(0, 1, 0));
  const double tall = std::tan(0.5 * view.yfov);
  out.camera.focal = {static_cast<double>(view.height) / (tall * view.width), 1.0 / tall};
  const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(out.camera.viewFromWorld));
  const glm::dvec3 eye = view.eye * impl_->scale;
  // Not unit: one metre of it is one metre of planar depth.
  const auto direction = [&](double px, double py) {
    const double ndcX = 2.0 * px / view.width - 1.0, ndcY = 1.0 - 2.0 * py / view.height;
    return worldFromView * glm::dvec3(ndcX / out.camera.focal.x, ndcY / out.camera.focal.y, -1.0);
  };
  out.viewZ = Image<float>(width, height, kInfinity);
  out.rims.data = out.data;
  out.rims.viewZ = out.viewZ;
  out.rims.coverage = Image<float>(width, height, 0.0f);
  out.layer = out.rims;
  out.rimGradient = Image<glm::vec2>(width, height, glm::vec2(0.0f));
  out.rimPoint = out.rimNormal = out.solidPoint = out.solidNormal = Image<glm::dvec3>(width, height, glm::dvec3(0));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const double px = out.data.x0 + x + 0.5, py = out.data.y0 + y + 0.5;
      // The pixel's quad, as GL takes derivatives.
      const double qx = (x & 1) ? px - 1 : px, qy = (y & 1) ? py - 1 : py;
      const glm::dvec3 d = direction(px, py);
      float from = 0.0f;
      while (true) {
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(eye.x), ray.ray.org_y = static_cast<float>(eye.y);
        ray.ray.org_z = static_cast<float>(eye.z);
        ray.ray.dir_x = static_cast<float>(d.x), ray.ray.dir_y = static_cast<float>(d.y);
        ray.ray.dir_z = static_cast<float>(d.z);
        ray.ray.tnear = from, ray.ray.tfar = kInfinity, ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(impl_->scene, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
        from = ray.ray.tfar * (1.0f + 1e-6f);
        const auto& [card, which] = impl_->cards[ray.hit.primID / 2];
        const Mask& mask = impl_->masks[which];
        double z = 0.0, other = 0.0;
        Impl::onCard(card, eye, d, z);
        float coverage = 1.0f;
        glm::vec2 gradient(0.0f);
        if (!mask.levels.empty()) {
          const glm::dvec2 size(mask.levels[0].width(), mask.levels[0].height());
          const auto at = [&](double ax, double ay) { return Impl::onCard(card, eye, direction(ax, ay), other); };
          const glm::dvec2 corner = at(qx, qy), across = at(qx + 1, qy), down = at(qx, qy + 1);
          const double rho = std::max(glm::length((across - corner) * size), glm::length((down - corner) * size));
          const double lod = std::log2(std::max(rho, 1e-9));
          const auto alpha = [&](double ax, double ay) {
            const glm::dvec2 there = at(ax, ay);
            return mask.trilinear(there.x, there.y, lod);
          };
          const float left = alpha(qx, py), right = alpha(qx + 1, py), top = alpha(px, qy), bottom = alpha(px, qy + 1);
          const float change = std::abs(right - left) + std::abs(bottom - top);
          const auto covered = [&](float a) { return shading::rimCoverage(a, kCutoff, change); };
          coverage = covered(alpha(px, py));
          gradient = {covered(right) - covered(left), covered(bottom) - covered(top)};
        }
        if (coverage <= 0.0f) continue;
        glm::dvec3 normal = glm::normalize(glm::cross(card.right, card.up));
        if (glm::dot(normal, d) > 0.0) normal = -normal;
        if (coverage < 1.0f) {
          if (out.rims.coverage.at(x, y) > 0.0f) continue;
          out.rims.coverage.at(x, y) = out.layer.coverage.at(x, y) = coverage;
          out.rims.viewZ.at(x, y) = out.layer.viewZ.at(x, y) = static_cast<float>(z);
          out.rimGradient.at(x, y) = gradient;
          out.rimPoint.at(x, y) = eye + z * d;
          out.rimNormal.at(x, y) = normal;
          continue;
        }
        if (!mask.levels.empty()) {
          out.layer.coverage.at(x, y) = 1.0f;
          out.layer.viewZ.at(x, y) = std::min(out.layer.viewZ.at(x, y), static_cast<float>(z));
        }
        out.viewZ.at(x, y) = static_cast<float>(z);
        out.solidPoint.at(x, y) = eye + z * d;
        out.solidNormal.at(x, y) = normal;
        break;
      }
    }
  });
  return out;
}

}  // namespace pellucid::test
