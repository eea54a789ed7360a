#include "engine_bridge/embree/opaque_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pellucid::rays {
namespace {

// Copies of a primitive beyond this many triangles are instanced; fewer are cheaper to trace laid out flat.
constexpr std::size_t kFlatTriangles = std::size_t{1} << 18;

// Looks through triangles that turn their back. Only camera rays pass by here.
void cullBackFaces(const RTCFilterFunctionNArguments* arguments) {
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const float facing =
        RTCHitN_Ng_x(arguments->hit, arguments->N, i) * RTCRayN_dir_x(arguments->ray, arguments->N, i) +
        RTCHitN_Ng_y(arguments->hit, arguments->N, i) * RTCRayN_dir_y(arguments->ray, arguments->N, i) +
        RTCHitN_Ng_z(arguments->hit, arguments->N, i) * RTCRayN_dir_z(arguments->ray, arguments->N, i);
    const bool mirrored = arguments->geometryUserPtr != nullptr;
    if (mirrored ? facing < 0.0f : facing > 0.0f) arguments->valid[i] = 0;
  }
}

bool isOpaque(const Scene& scene, const Instance& instance) {
  const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
  return !scene.materials.at(static_cast<std::size_t>(primitive.material)).transparent();
}

}  // namespace

//   mirrored  the triangles will be instanced by transforms that turn their sides round
RTCGeometry OpaqueScene::triangleGeometry(const Primitive& primitive, const glm::dmat4& transform, bool singleSided,
                                          bool mirrored) const {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, primitive.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, primitive.indices.size() / 3));
  if (!corners || !indices) {
    rtcReleaseGeometry(geometry);
    throw ResourceError("Embree: memory ran out while laying out triangles, expected less geometry");
  }
  for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
    const glm::vec3 p(transform * glm::dvec4(glm::dvec3(primitive.vertices[i].position), 1.0));
    std::memcpy(corners + 3 * i, &p, sizeof p);
  }
  std::copy(primitive.indices.begin(),
            primitive.indices.begin() + static_cast<std::ptrdiff_t>(primitive.indices.size() / 3 * 3), indices);
  // Any pointer that is not null says so to the filter.
  if (mirrored) rtcSetGeometryUserData(geometry, const_cast<Primitive*>(&primitive));
  if (singleSided) rtcSetGeometryIntersectFilterFunction(geometry, cullBackFaces);
  return geometry;
}

void OpaqueScene::attach(RTCGeometry geometry, std::uint32_t instance) {
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(top_, geometry);
  rtcReleaseGeometry(geometry);
  if (instanceOf_.size() <= id) instanceOf_.resize(id + 1, kMissed);
  instanceOf_[id] = instance;
}

OpaqueScene::OpaqueScene(const Scene& scene, const Camera& camera)
    : scene_(scene), placed_(placeInstances(scene, camera)), top_(device_) {
  std::map<int, std::size_t> uses;
  for (const Instance& instance : scene.instances)
    if (isOpaque(scene, instance)) ++uses[instance.primitive];

  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!isOpaque(scene, instance)) continue;
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    const bool singleSided = !scene.materials[static_cast<std::size_t>(primitive.material)].bothSides();
    const std::size_t triangles = primitive.indices.size() / 3;
    triangles_ += triangles;
    const glm::dmat4& transform = placed_[i].viewFromObject;
    const auto index = static_cast<std::uint32_t>(i);
    if ((uses[instance.primitive] - 1) * triangles <= kFlatTriangles) {
      attach(triangleGeometry(primitive, transform, singleSided, false), index);
      continue;
    }
    const bool mirrored = glm::determinant(glm::dmat3(transform)) < 0.0;
    Shared& shared = shared_[{instance.primitive, mirrored}];
    if (!shared.scene) {
      shared.scene = SceneHandle(device_);
      RTCGeometry geometry = triangleGeometry(primitive, glm::dmat4(1.0), singleSided, mirrored);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(shared.scene, geometry);
      rtcReleaseGeometry(geometry);
      rtcCommitScene(shared.scene);
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, shared.scene);
    float columns[12];
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) columns[3 * c + r] = static_cast<float>(transform[c][r]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    attach(geometry, index);
  }
  rtcCommitScene(top_);
  device_.check("building the BVH");
}

void OpaqueScene::traceBlock(const CameraRays& rays, int x, int y, BlockHits& hits) const {
  std::array<glm::vec2, 16> centres;
  centres.fill(glm::vec2(0.5f));
  traceBlock(rays, x, y, centres, hits);
}

void OpaqueScene::traceBlock(const CameraRays& rays, int x, int y, const std::array<glm::vec2, 16>& samples,
                             BlockHits& hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[16];
  RTCRayHit16 packet;
  for (int i = 0; i < 16; ++i) {
    const glm::vec2 sample = samples[static_cast<std::size_t>(i)];
    const Ray ray =
        rays.through({x + i % 4 + static_cast<double>(sample.x), y + i / 4 + static_cast<double>(sample.y)});
    valid[i] = -1;
    packet.ray.org_x[i] = static_cast<float>(ray.origin.x);
    packet.ray.org_y[i] = static_cast<float>(ray.origin.y);
    packet.ray.org_z[i] = static_cast<float>(ray.origin.z);
    packet.ray.dir_x[i] = static_cast<float>(ray.direction.x);
    packet.ray.dir_y[i] = static_cast<float>(ray.direction.y);
    packet.ray.dir_z[i] = static_cast<float>(ray.direction.z);
    packet.ray.tnear[i] = 0.0f;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = 0.0f;
    packet.ray.mask[i] = 0xffffffffu;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect16(valid, top_, &context, &packet);
  for (int i = 0; i < 16; ++i) {
    const unsigned inner = packet.hit.geomID[i], outer = packet.hit.instID[0][i];
    hits.instance[i] =
        inner == RTC_INVALID_GEOMETRY_ID ? kMissed : instanceOf_[outer == RTC_INVALID_GEOMETRY_ID ? inner : outer];
    hits.triangle[i] = packet.hit.primID[i];
  }
}

bool OpaqueScene::blocked(glm::vec3 origin, glm::vec3 direction, float reach) const {
  return occluded(top_, origin, direction, reach);
}

}  // namespace pellucid::rays
