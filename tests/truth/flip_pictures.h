// Pairs of pictures whose FLIP is known from the authors' own program.
#pragma once
#include <cstdint>

namespace pellucid::test {

constexpr int kFlipWidth = 96, kFlipHeight = 64, kFlipPairs = 5;

inline float flipNoise(int x, int y, int salt) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca77u ^
                    static_cast<std::uint32_t>(salt) * 0xc2b2ae3du;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return static_cast<float>((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

// Linear value of channel c at (x, y), of the first or second picture of a pair.
inline float flipValue(int pair, bool second, int x, int y, int c) {
  const float u = static_cast<float>(x) / 95.0f, v = static_cast<float>(y) / 63.0f;
  const float ramp = c == 0 ? u : c == 1 ? v : 1.0f - u;
  switch (pair) {
    case 0:  // a ramp, a little brighter
      return ramp * (second ? 0.9f : 1.0f);
    case 1:  // a checker, moved by a pixel
      return ((x + (second ? 1 : 0)) / 6 + y / 6) % 2 ? 0.8f : 0.1f;
    case 2:  // noise against other noise
      return flipNoise(x, y, c + (second ? 10 : 0));
    case 3:  // a bright dot and a thin line, or none
      return second && ((x == 48 && y == 20) || y == 50) ? 1.0f : 0.2f;
    default:  // red for green on half of it
      return second && x > 40 ? (c == 0 ? 0.7f : 0.1f) : (c == 1 ? 0.7f : 0.1f);
  }
}

}  // namespace pellucid::test
