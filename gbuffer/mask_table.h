// Random orders of S samples, from which stratified masks are cut: on the CPU, and on GL as a texture of the same
// ranks.
#pragma once
#include <cstdint>
#include <vector>

#include "shaders/stochastic_mask.h"

namespace pellucid {

class MaskTable {
 public:
  explicit MaskTable(int samples);
  // Rank of sample s, [0, S), in the order that `key` picks. Over keys, all subsets are equally likely, but for the
  // finite table.
  std::uint32_t rank(std::uint32_t key, std::uint32_t s) const { return ranks_[shading::maskPlace(key, s, samples_)]; }
  const std::vector<std::uint16_t>& ranks() const { return ranks_; }

 private:
  std::uint32_t samples_;
  std::vector<std::uint16_t> ranks_;
};

}  // namespace pellucid
