#include "engine_bridge/gl/solid_hash.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace pellucid::gl {

std::string solidHash(const Image<glm::vec4>& solid) {
  // FNV-1a over words of 8 bytes.
  std::uint64_t hash = 0xcbf29ce484222325u;
  bool any = false;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    any = any || std::isfinite(solid[i].a);
    std::uint64_t words[2];
    std::memcpy(words, &solid[i], sizeof(words));
    for (const std::uint64_t word : words) {
      hash = (hash ^ word) * 0x100000001b3u;
      hash ^= hash >> 29;
    }
  }
  return any ? fmt::format("{:016x}", hash) : std::string();
}

}  // namespace pellucid::gl
