// Values of a channel, as float, at the pixels of another window.
#pragma once
#include <Imath/half.h>

#include <algorithm>
#include <cstring>

#include "gbuffer/exr_document.h"

namespace pellucid {

template <PixelType type>
float valueAt(const std::byte* bytes, std::size_t i) {
  if constexpr (type == PixelType::half) {
    std::uint16_t bits;
    std::memcpy(&bits, bytes + i * 2, 2);
    return imath_half_to_float(bits);
  } else if constexpr (type == PixelType::uint32) {
    std::uint32_t value;
    std::memcpy(&value, bytes + i * 4, 4);
    return static_cast<float>(value);
  } else {
    float value;
    std::memcpy(&value, bytes + i * 4, 4);
    return value;
  }
}

template <PixelType type, class Visit>
void visitTyped(const ExrChannel& channel, const Window& from, const Window& to, Visit visit) {
  const int y0 = std::max(from.y0, to.y0), y1 = std::min(from.y1, to.y1);
  const int x0 = std::max(from.x0, to.x0), x1 = std::min(from.x1, to.x1);
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y - from.y0) * static_cast<std::size_t>(from.width());
    for (int x = x0; x < x1; ++x)
      visit(x - to.x0, y - to.y0, valueAt<type>(channel.bytes.data(), row + static_cast<std::size_t>(x - from.x0)));
  }
}

// Calls visit(x, y, value) for each pixel that both windows hold; x and y count from the top left of `to`.
//   from  the data window of the channel's part
template <class Visit>
void visitPixels(const ExrChannel& channel, const Window& from, const Window& to, Visit visit) {
  if (channel.type == PixelType::half)
    visitTyped<PixelType::half>(channel, from, to, visit);
  else if (channel.type == PixelType::uint32)
    visitTyped<PixelType::uint32>(channel, from, to, visit);
  else
    visitTyped<PixelType::float32>(channel, from, to, visit);
}

}  // namespace pellucid
