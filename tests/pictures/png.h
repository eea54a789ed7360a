// Images for glTF files that tests write: PNG, not compressed.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::test {

// 8 bits a channel, straight alpha; row 0 on top.
std::string pngOf(int width, int height, const std::vector<std::uint8_t>& rgba);

}  // namespace pellucid::test
