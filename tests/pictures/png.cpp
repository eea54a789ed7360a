#include "tests/pictures/png.h"

namespace pellucid::test {
namespace {

std::string bigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift));
  return bytes;
}

std::uint32_t crcOf(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
  return bigEndian(static_cast<std::uint32_t>(data.size())) + type + data + bigEndian(crcOf(type + data));
}

// zlib, in blocks that are stored as they are.
std::string stored(const std::string& raw) {
  std::string out("\x78\x01", 2);
  std::uint32_t a = 1, b = 0;
  for (const char byte : raw) {
    a = (a + static_cast<std::uint8_t>(byte)) % 65521u;
    b = (b + a) % 65521u;
  }
  for (std::size_t at = 0; at < raw.size(); at += 65535) {
    const std::size_t size = std::min<std::size_t>(raw.size() - at, 65535), other = ~size;
    out.push_back(at + size == raw.size() ? '\1' : '\0');
    for (const std::size_t number : {size, other}) {
      out.push_back(static_cast<char>(number));
      out.push_back(static_cast<char>(number >> 8));
    }
    out += raw.substr(at, size);
  }
  return out + bigEndian(b << 16 | a);
}

}  // namespace

std::string pngOf(int width, int height, const std::vector<std::uint8_t>& rgba) {
  const auto w = static_cast<std::size_t>(width);
  std::string raw;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    raw.push_back('\0');  // no filter
    raw.append(reinterpret_cast<const char*>(rgba.data()) + 4 * w * y, 4 * w);
  }
  const std::string head = bigEndian(static_cast<std::uint32_t>(width)) +
                           bigEndian(static_cast<std::uint32_t>(height)) + std::string("\x08\x06\0\0\0", 5);
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", head) + chunk("IDAT", stored(raw)) + chunk("IEND", "");
}

}  // namespace pellucid::test
