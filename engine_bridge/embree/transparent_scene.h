// The transparent triangles of a scene, in one camera's view space, as candidates for exact tests of our own: Embree
// only says which boxes a ray enters. Its own triangle test reports both triangles of a shared edge, or none.
#pragma once
#include <cstdint>
#include <vector>

#include "engine_bridge/embree/embree_device.h"
#include "engine_bridge/embree/triangle.h"
#include "engine_bridge/scene/placed.h"

namespace pellucid::rays {

struct Crossing {
  std::uint32_t instance, triangle;
  TriangleHit hit;
};

class TransparentScene {
 public:
  // Throws ResourceError when memory runs out. The scene must outlive this.
  TransparentScene(const Scene& scene, const Camera& camera);

  // Every crossing of the ray with 0 < z <= reach, in no order: back faces of single-sided materials left out.
  void cross(const Ray& ray, float reach, std::vector<Crossing>& crossings) const;
  // Every crossing of any ray with 0 < t <= reach, in no order, both sides of everything: for rays that are not the
  // camera's. hit.z is t, in lengths of the direction; hit.front is as seen from the origin.
  //   reach  infinity allowed
  void crossAny(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                std::vector<Crossing>& crossings) const;

  const Scene& scene() const { return scene_; }
  const Placed& placed(std::uint32_t instance) const { return placed_[instance]; }

 private:
  struct Part {  // what Embree's callbacks know of a geometry
    const TransparentScene* owner;
    std::uint32_t instance;
    bool singleSided;
    std::vector<Corners> corners = {};  // of its triangles, in view space; empty where there are too many to keep
  };
  struct Query;
  static void boundsOf(const RTCBoundsFunctionArguments* arguments);
  static void test(const RTCIntersectFunctionNArguments* arguments);
  static Corners cornersIn(const Part& part, std::size_t triangle);
  void run(Query& query, float reach) const;
  const Primitive& primitiveOf(std::uint32_t instance) const {
    return scene_.primitives[static_cast<std::size_t>(scene_.instances[instance].primitive)];
  }

  Device device_;
  const Scene& scene_;
  bool orthographic_;
  std::vector<Placed> placed_;
  std::vector<Part> parts_;  // never moves once the BVH is built
  SceneHandle top_;
};

}  // namespace pellucid::rays
