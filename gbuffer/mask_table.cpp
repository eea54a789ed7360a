#include "gbuffer/mask_table.h"

#include <numeric>
#include <utility>

namespace pellucid {
namespace {

constexpr std::uint32_t kRows = 1u << shading::PLD_MASK_ROW_BITS;

}  // namespace

MaskTable::MaskTable(int samples) : samples_(static_cast<std::uint32_t>(samples)), ranks_(kRows * samples_) {
  for (std::uint32_t row = 0; row < kRows; ++row) {
    const auto begin = ranks_.begin() + static_cast<std::ptrdiff_t>(row * samples_);
    std::iota(begin, begin + static_cast<std::ptrdiff_t>(samples_), std::uint16_t{0});
    for (std::uint32_t left = samples_; left > 1; --left) {  // Fisher-Yates
      const std::uint64_t draw = shading::hashOf(shading::hashOf(row) + left);
      std::swap(begin[static_cast<std::ptrdiff_t>(left - 1)], begin[static_cast<std::ptrdiff_t>(draw * left >> 32)]);
    }
  }
}

}  // namespace pellucid
