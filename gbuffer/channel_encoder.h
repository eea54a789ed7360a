// Floats to the bytes of a channel.
#pragma once
#include <Imath/half.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {

// Half rounds to nearest even; finite values beyond its range stay finite.
class ChannelEncoder {
 public:
  void put(ExrChannel& channel, std::size_t i, float value) { put(channel.bytes, channel.type, i, value); }
  void put(std::vector<std::byte>& bytes, PixelType type, std::size_t i, float value) {
    if (type == PixelType::float32) {
      std::memcpy(bytes.data() + i * 4, &value, 4);
      return;
    }
    if (std::isfinite(value) && std::abs(value) > kLargestHalf) {
      value = std::copysign(kLargestHalf, value);
      ++clamped_;
    }
    const std::uint16_t bits = imath_float_to_half(value);
    std::memcpy(bytes.data() + i * 2, &bits, 2);
  }
  void add(const ChannelEncoder& other) { clamped_ += other.clamped_; }
  void noteTo(std::vector<std::string>& notes) const {
    if (clamped_ > 0) notes.push_back(fmt::format("{} values beyond 65504, the largest half, became 65504", clamped_));
  }

 private:
  static constexpr float kLargestHalf = 65504.0f;
  std::size_t clamped_ = 0;
};

// Layers as channels of one type, each of the size of the data window.
std::vector<ExrChannel> channelsOf(const std::vector<ExtraLayer>& layers, const Window& data, PixelType type,
                                   ChannelEncoder& encoder);

}  // namespace pellucid
