#include "engine_bridge/embree/transparent_scene.h"

#include <algorithm>
#include <cmath>

namespace pellucid::rays {

struct TransparentScene::Query {
  RTCIntersectContext context;  // first, so that a pointer to it is one to this
  const Ray* ray;
  std::vector<Crossing>* crossings;
  bool any;      // not a camera's ray: both sides, by distance
  double reach;  // of those
};

namespace {

// Triangles whose corners are kept as rays meet them, 72 bytes each; those of larger scenes are placed at every test.
constexpr std::size_t kMostPlaced = std::size_t{1} << 20;

// Of the point that `hit` weighs, along the ray, in lengths of its direction.
double distanceAlong(const Ray& ray, const Corners& corners, const TriangleHit& hit) {
  const glm::dvec3 point = hit.weight[0] * corners.p[0] + hit.weight[1] * corners.p[1] + hit.weight[2] * corners.p[2];
  return glm::dot(point - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
}

}  // namespace

Corners TransparentScene::cornersIn(const Part& part, std::size_t triangle) {
  if (!part.corners.empty()) return part.corners[triangle];
  const TransparentScene& owner = *part.owner;
  return cornersOf(owner.primitiveOf(part.instance), owner.placed_[part.instance].viewFromObject, triangle);
}

// Wider than the triangle by far more than the rounding of Embree's own arithmetic, which is in float.
void TransparentScene::boundsOf(const RTCBoundsFunctionArguments* arguments) {
  const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
  const Corners corners = cornersIn(part, arguments->primID);
  const glm::dvec3 low = glm::min(corners.p[0], glm::min(corners.p[1], corners.p[2]));
  const glm::dvec3 high = glm::max(corners.p[0], glm::max(corners.p[1], corners.p[2]));
  const glm::dvec3 reach = glm::max(glm::abs(low), glm::abs(high));
  const double slack = 2e-6 * std::max({reach.x, reach.y, reach.z});
  RTCBounds& box = *arguments->bounds_o;
  box.lower_x = static_cast<float>(low.x - slack);
  box.lower_y = static_cast<float>(low.y - slack);
  box.lower_z = static_cast<float>(low.z - slack);
  box.upper_x = static_cast<float>(high.x + slack);
  box.upper_y = static_cast<float>(high.y + slack);
  box.upper_z = static_cast<float>(high.z + slack);
}

// Collects, and leaves Embree's ray as it is: so it goes on to the next box.
void TransparentScene::test(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
  const TransparentScene& owner = *part.owner;
  auto* query = reinterpret_cast<Query*>(arguments->context);
  const Corners corners = cornersIn(part, arguments->primID);
  std::optional<TriangleHit> hit = intersectHalfOpen(*query->ray, corners, query->any ? false : owner.orthographic_);
  if (hit && query->any) {
    hit->z = distanceAlong(*query->ray, corners, *hit);
    if (hit->z > 0.0 && hit->z <= query->reach) query->crossings->push_back({part.instance, arguments->primID, *hit});
    return;
  }
  if (!hit || !(hit->z > 0.0) || (part.singleSided && !hit->front)) return;
  query->crossings->push_back({part.instance, arguments->primID, *hit});
}

TransparentScene::TransparentScene(const Scene& scene, const Camera& camera)
    : scene_(scene), orthographic_(camera.orthographic), placed_(placeInstances(scene, camera)), top_(device_) {
  rtcSetSceneFlags(top_, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(scene.instances[i].primitive));
    const Material& material = scene.materials.at(static_cast<std::size_t>(primitive.material));
    // Particles have no surface: what they hide of a light is their grid's (scene/particle_grid.h).
    if (material.transparent() && !primitive.points)
      parts_.push_back({this, static_cast<std::uint32_t>(i), !material.bothSides()});
  }
  std::size_t triangles = 0;
  for (const Part& part : parts_) triangles += primitiveOf(part.instance).indices.size() / 3;
  for (Part& part : parts_) {
    const Primitive& primitive = primitiveOf(part.instance);
    for (std::size_t i = 0; triangles <= kMostPlaced && i < primitive.indices.size() / 3; ++i)
      part.corners.push_back(cornersOf(primitive, placed_[part.instance].viewFromObject, i));
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitiveOf(part.instance).indices.size() / 3));
    rtcSetGeometryUserData(geometry, &part);
    rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
    rtcSetGeometryIntersectFunction(geometry, test);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(top_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(top_);
  device_.check("building the BVH of transparent triangles");
}

void TransparentScene::run(Query& query, float reach) const {
  rtcInitIntersectContext(&query.context);
  RTCRayHit packet{};
  packet.ray.org_x = static_cast<float>(query.ray->origin.x);
  packet.ray.org_y = static_cast<float>(query.ray->origin.y);
  packet.ray.org_z = static_cast<float>(query.ray->origin.z);
  packet.ray.dir_x = static_cast<float>(query.ray->direction.x);
  packet.ray.dir_y = static_cast<float>(query.ray->direction.y);
  packet.ray.dir_z = static_cast<float>(query.ray->direction.z);
  packet.ray.tfar = reach * 1.0001f;  // boxes are found in float; what is beyond is left to the caller's test
  packet.ray.mask = 0xffffffffu;
  packet.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(top_, &query.context, &packet);
}

void TransparentScene::cross(const Ray& ray, float reach, std::vector<Crossing>& crossings) const {
  Query query{{}, &ray, &crossings, false, 0.0};
  run(query, reach);
}

void TransparentScene::crossAny(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                                std::vector<Crossing>& crossings) const {
  const Ray ray{origin, direction};
  Query query{{}, &ray, &crossings, true, reach};
  run(query, static_cast<float>(reach));
}

}  // namespace pellucid::rays
