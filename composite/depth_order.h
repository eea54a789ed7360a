// The order in depth of a pixel's few layers, without branches that depend on it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pellucid {

constexpr std::size_t kMostRanked = 32;

namespace ranking {

// A layer's place is how many are nearer: comparisons that vectorise, where sorting mispredicts.
template <int Lanes>
bool rank(const float* z, std::size_t count, std::uint32_t* order) {
  alignas(32) float depths[Lanes];
  alignas(32) std::uint32_t ranks[Lanes];
  for (int lane = 0; lane < Lanes; ++lane) {
    depths[lane] = std::numeric_limits<float>::infinity();
    ranks[lane] = 0;
  }
  std::memcpy(depths, z, count * sizeof(float));
  for (std::size_t i = 0; i < count; ++i) {
    const float nearer = z[i];
    for (int lane = 0; lane < Lanes; ++lane) ranks[lane] += depths[lane] > nearer ? 1u : 0u;
  }
  std::size_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    order[ranks[i]] = static_cast<std::uint32_t>(i);
    sum += ranks[i];
  }
  return 2 * sum == count * (count - 1);  // less where two share a rank
}

}  // namespace ranking

// Writes the indices of `count` depths from near to far. False, and nothing that means anything written, when two of
// them are equal or one is not a number.
//   count  at most kMostRanked
//   order  room for `count`
inline bool orderByDepth(const float* z, std::size_t count, std::uint32_t* order) {
  if (count < 2) {
    if (count == 1) order[0] = 0;
    return true;
  }
  return count <= 16 ? ranking::rank<16>(z, count, order) : ranking::rank<kMostRanked>(z, count, order);
}

}  // namespace pellucid
