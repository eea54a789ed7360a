// Random numbers as integer hashes, so that every run and every thread count writes the same bytes.
#pragma once
#include <cstdint>

namespace pellucid::samples {

// PCG's output permutation over a linear congruential step. Jarzynski, Olano: Hash Functions for GPU Rendering, 2020.
inline std::uint32_t hash(std::uint32_t x) {
  const std::uint32_t state = x * 747796405u + 2891336453u;
  const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}
inline std::uint32_t hash(std::uint32_t x, std::uint32_t y) {
  return hash(x + hash(y));
}
inline std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return hash(x, hash(y, z));
}

// [0, 1)
inline double unit(std::uint32_t bits) {
  return bits * (1.0 / 4294967296.0);
}

}  // namespace pellucid::samples
