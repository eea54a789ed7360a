// Owners of Embree objects, and its errors as ours.
#pragma once
#include <embree3/rtcore.h>

#include <glm/glm.hpp>
#include <utility>

#include "gbuffer/errors.h"

namespace pellucid::rays {

class Device {
 public:
  // Throws ResourceError.
  Device() : device_(rtcNewDevice(nullptr)) {
    if (!device_) throw ResourceError("Embree: no device could be made, expected a CPU with SSE2 and free memory");
  }
  ~Device() { rtcReleaseDevice(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  operator RTCDevice() const { return device_; }

  // Throws ResourceError when Embree reported an error since the last call. `doing` is a phrase: "building the BVH".
  void check(const char* doing) const;

 private:
  RTCDevice device_;
};

class SceneHandle {
 public:
  SceneHandle() = default;
  explicit SceneHandle(RTCDevice device) : scene_(rtcNewScene(device)) {}
  ~SceneHandle() {
    if (scene_) rtcReleaseScene(scene_);
  }
  SceneHandle(SceneHandle&& other) noexcept : scene_(std::exchange(other.scene_, nullptr)) {}
  SceneHandle& operator=(SceneHandle&& other) noexcept {
    std::swap(scene_, other.scene_);
    return *this;
  }
  operator RTCScene() const { return scene_; }

 private:
  RTCScene scene_ = nullptr;
};

// Whether anything of the scene lies within `reach` (in lengths of `direction`) of the origin.
bool occluded(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float reach);

}  // namespace pellucid::rays
