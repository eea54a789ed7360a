#include "engine_bridge/embree/device.h"

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

}  // namespace pellucid::rays
