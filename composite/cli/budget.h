// The least that --budget takes.
#pragma once
#include <cstddef>
#include <string>

namespace pellucid::cli {

// Below it every band of fragments would sweep over all chunks of a few triangles each: the work grows with the inverse
// square of the budget, while the process takes more memory than this anyway.
constexpr std::size_t kLeastBudget = std::size_t{1} << 20;

// Bytes of --budget. Says so where it takes kLeastBudget instead. Throws UsageError.
std::size_t parseBudget(const std::string& text);

}  // namespace pellucid::cli
