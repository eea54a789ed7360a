// WebP's alpha, taken off the container's header: decoders then give the colours as they are stored.
#include <cstddef>

#include "engine_bridge/scene/textures.h"

namespace pellucid::gltf {

std::optional<std::vector<std::uint8_t>> withoutWebpAlpha(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 12;            // RIFF, size, WEBP
  constexpr std::uint8_t kExtendedAlpha = 0x10;  // of VP8X' first byte
  constexpr std::uint8_t kLosslessAlpha = 0x10;  // of VP8L's fifth byte: 14 bits of width, 14 of height, then alpha
  std::vector<std::uint8_t> opaque = bytes;
  bool found = false;
  const auto clear = [&](std::size_t at, std::uint8_t bit) {
    if (at >= opaque.size() || (opaque[at] & bit) == 0) return;
    opaque[at] = static_cast<std::uint8_t>(opaque[at] & ~bit);
    found = true;
  };
  for (std::size_t at = kHeader; at + 8 <= bytes.size();) {
    const std::size_t size = static_cast<std::size_t>(bytes[at + 4]) | static_cast<std::size_t>(bytes[at + 5]) << 8 |
                             static_cast<std::size_t>(bytes[at + 6]) << 16 |
                             static_cast<std::size_t>(bytes[at + 7]) << 24;
    const std::string kind(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                           bytes.begin() + static_cast<std::ptrdiff_t>(at + 4));
    if (kind == "VP8X") clear(at + 8, kExtendedAlpha);
    if (kind == "VP8L" && at + 8 < bytes.size() && bytes[at + 8] == 0x2f) clear(at + 8 + 4, kLosslessAlpha);
    at += 8 + size + size % 2;
  }
  if (!found) return std::nullopt;
  return opaque;
}

}  // namespace pellucid::gltf
