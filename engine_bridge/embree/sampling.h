// Well spread sample points from integer hashes: Owen-scrambled Sobol points, a different scramble for every pixel and
// use. Points 0 to 2^k - 1 of a set are stratified for every k.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/shading.h"

namespace pellucid::rays {

inline std::uint32_t reverseBits(std::uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Nested uniform scramble of the bits of x, after Laine and Karras (Stratified Sampling for Stochastic Transparency,
// EGSR 2011), with the constants of Vegdahl.
inline std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reverseBits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverseBits(x);
}

// Second dimension of Sobol's sequence.
inline std::uint32_t sobolSecond(std::uint32_t index) {
  std::uint32_t bits = 0;
  for (std::uint32_t direction = 0x80000000u; index; index >>= 1, direction ^= direction >> 1)
    if (index & 1u) bits ^= direction;
  return bits;
}

inline float unitFloat(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

// Point `index` of the set that `seed` names. [0,1)^2
inline glm::vec2 samplePoint(std::uint32_t index, std::uint32_t seed) {
  const std::uint32_t shuffled = scrambled(index, shading::hashOf(seed));
  return {unitFloat(scrambled(reverseBits(shuffled), shading::hashOf(seed ^ 0x68bc21ebu))),
          unitFloat(scrambled(sobolSecond(shuffled), shading::hashOf(seed ^ 0x02e5be93u)))};
}

// Names the sets of one pixel.
//   use  what the points are for: sets of different uses are independent
inline std::uint32_t pixelSeed(int x, int y, std::uint32_t use) {
  return shading::hashOf(static_cast<std::uint32_t>(x) ^
                         shading::hashOf(static_cast<std::uint32_t>(y) ^ shading::hashOf(use)));
}

// Two directions that make a right-handed frame with the unit vector n. Duff et al. (Building an Orthonormal Basis,
// Revisited, JCGT 2017)
struct Frame {
  glm::vec3 s, t, n;
  explicit Frame(glm::vec3 normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  glm::vec3 from(glm::vec3 local) const { return s * local.x + t * local.y + n * local.z; }
};

// Direction about +z with density cos / pi.
inline glm::vec3 cosineDirection(glm::vec2 u) {
  const float radius = std::sqrt(u.x), angle = 2.0f * shading::PLD_PI * u.y;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(1.0f - u.x, 0.0f))};
}

}  // namespace pellucid::rays
