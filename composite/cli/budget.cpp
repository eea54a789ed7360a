#include "composite/cli/budget.h"

#include "composite/cli/messages.h"
#include "composite/cli/options.h"

namespace pellucid::cli {

std::size_t parseBudget(const std::string& text) {
  const std::size_t bytes = parseBytes(text, "--budget");
  if (bytes >= kLeastBudget) return bytes;
  note("--budget {} is less than the least, {}M, which is taken instead", text, kLeastBudget >> 20);
  return kLeastBudget;
}

}  // namespace pellucid::cli
