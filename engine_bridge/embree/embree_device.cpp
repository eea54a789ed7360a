#include "engine_bridge/embree/embree_device.h"

#include <fmt/format.h>

#include <stdexcept>

namespace pellucid::rays {

void Device::check(const char* doing) const {
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw ResourceError(fmt::format("Embree: memory ran out while {}, expected less geometry", doing));
  throw std::logic_error(fmt::format("Embree reported error {} while {}", static_cast<int>(error), doing));
}

bool occluded(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float reach) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = reach;
  ray.mask = 0xffffffffu;
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace pellucid::rays
