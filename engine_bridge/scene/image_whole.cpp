// Whether an encoded image is all there. libjpeg paints what is missing grey without an error, and OpenImageIO's PNG
// reader leaks when it runs dry.
#include <cstddef>

#include "engine_bridge/scene/textures.h"

namespace pellucid::gltf {

namespace {

// Chunks of a length each, to IEND.
bool isWholePng(const std::vector<std::uint8_t>& bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = static_cast<std::size_t>(bytes[at]) << 24 |
                               static_cast<std::size_t>(bytes[at + 1]) << 16 |
                               static_cast<std::size_t>(bytes[at + 2]) << 8 | static_cast<std::size_t>(bytes[at + 3]);
    if (length > bytes.size() - at - 12) return false;
    const bool end = bytes[at + 4] == 'I' && bytes[at + 5] == 'E' && bytes[at + 6] == 'N' && bytes[at + 7] == 'D';
    if (end) return true;
    at += 12 + length;
  }
  return false;
}

// Marker segments of a length each, to the first scan; entropy-coded bytes hold no FF D9 but the end of the image.
bool isWholeJpeg(const std::vector<std::uint8_t>& bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == 0xff) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {  // fill
      ++at;
      continue;
    }
    if (marker == 0xd9) return true;
    if (marker == 0xda) break;
    const std::size_t length = static_cast<std::size_t>(bytes[at + 2]) << 8 | static_cast<std::size_t>(bytes[at + 3]);
    if (length < 2 || length > bytes.size() - at - 2) return false;
    at += 2 + length;
  }
  for (; at + 2 <= bytes.size(); ++at) {
    if (bytes[at] == 0xff && bytes[at + 1] == 0xd9) return true;
  }
  return false;
}

}  // namespace

bool isWholeImage(const std::vector<std::uint8_t>& bytes, const std::string& format) {
  if (format == "png") return isWholePng(bytes);
  if (format == "jpg") return isWholeJpeg(bytes);
  return true;
}

}  // namespace pellucid::gltf
