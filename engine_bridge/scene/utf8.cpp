#include "engine_bridge/scene/utf8.h"

#include <algorithm>
#include <cstdint>

namespace pellucid::gltf {
namespace {

// Bytes of the character that begins at `at`; 0 where none does (RFC 3629).
std::size_t lengthAt(Bytes text, std::size_t at) {
  const std::uint8_t first = text[at];
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                             : (first & 0xF0) == 0xE0         ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((text[at + k] & 0xC0) != 0x80) return 0;
  const std::uint8_t second = text[at + 1];
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);  // surrogates, U+10FFFF
  return overlong || beyond ? 0 : length;
}

}  // namespace

std::optional<std::string> fromLatin1(Bytes text) {
  std::string result;
  bool changed = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = lengthAt(text, at);
    if (length == 0) {
      if (!changed) result.reserve(text.size() + text.size() / 64);
      changed = true;
      result.push_back(static_cast<char>(0xC0 | text[at] >> 6));
      result.push_back(static_cast<char>(0x80 | (text[at] & 0x3F)));
    }
    for (std::size_t k = 0; k < length; ++k) result.push_back(static_cast<char>(text[at + k]));
    at += std::max<std::size_t>(length, 1);
  }
  if (!changed) return std::nullopt;
  return result;
}

}  // namespace pellucid::gltf
