// The opaque triangles of a scene, in one camera's view space, ready for rays.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine_bridge/embree/camera_rays.h"
#include "engine_bridge/embree/embree_device.h"
#include "engine_bridge/embree/surface_sampler.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::rays {

constexpr std::uint32_t kMissed = 0xffffffffu;

// What 16 rays hit: pixels (x + i % 4, y + i / 4) of a block.
struct BlockHits {
  alignas(64) std::uint32_t instance[16];  // into Scene::instances, kMissed for nothing
  alignas(64) std::uint32_t triangle[16];  // of the primitive
};

class OpaqueScene {
 public:
  // Throws ResourceError when memory runs out. The scene must outlive this.
  OpaqueScene(const Scene& scene, const Camera& camera);

  // Nearest hits of camera rays through the block of 4x4 pixels whose top left is (x, y), at `sample` in each pixel:
  // back faces of single-sided materials are looked through, as a rasteriser culls them.
  //   samples  16 positions, (0.5, 0.5) the centre, y down
  void traceBlock(const CameraRays& rays, int x, int y, const std::array<glm::vec2, 16>& samples,
                  BlockHits& hits) const;
  // The same at pixel centres.
  void traceBlock(const CameraRays& rays, int x, int y, BlockHits& hits) const;

  // Whether anything opaque, whichever side it shows, lies on the way. View space.
  //   reach  in lengths of `direction`, infinity allowed
  bool blocked(glm::vec3 origin, glm::vec3 direction, float reach) const;

  const Scene& scene() const { return scene_; }
  const Placed& placed(std::uint32_t instance) const { return placed_[instance]; }
  std::size_t triangles() const { return triangles_; }

 private:
  struct Shared {  // geometry that several instances use
    SceneHandle scene;
  };
  RTCGeometry triangleGeometry(const Primitive& primitive, const glm::dmat4& transform, bool singleSided,
                               bool mirrored) const;
  void attach(RTCGeometry geometry, std::uint32_t instance);

  Device device_;
  const Scene& scene_;
  std::vector<Placed> placed_;
  std::map<std::pair<int, bool>, Shared> shared_;  // by primitive, and whether its instances mirror
  SceneHandle top_;
  std::vector<std::uint32_t> instanceOf_;  // by geometry of the top scene
  std::size_t triangles_ = 0;
};

}  // namespace pellucid::rays
