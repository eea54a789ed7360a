#include "composite/pipeline/default_method.h"

#include <fmt/format.h>

namespace pellucid {

const std::vector<SumsFlag>& sumsFlags() {
  static const std::vector<SumsFlag> table{
      {"--tolerance", nullptr, "the sums where they provably lie within it, the truth elsewhere", false},
      {"--systems", "off", "passes for each system are passes of sums", true},
      {"--weight", nullptr, "only sums weigh their layers", true},
      {"--weight-range", nullptr, "only sums weigh their layers", true},
      {"--weight-reference", nullptr, "only sums weigh their layers", true},
      {"--weight-from", nullptr, "only sums weigh their layers", true},
      {"--normalisation", nullptr, "only sums are normalised", true},
      {"--self-modulation", nullptr, "it corrects the sums", true},
      {"--precision", nullptr, "it says what the sums are kept in", true},
      {"--resolve", "cpu", "only sums are resolved", true},
  };
  return table;
}

MethodDecision decideMethod(const std::vector<GivenFlag>& given) {
  for (const SumsFlag& row : sumsFlags())
    for (const GivenFlag& flag : given) {
      if (flag.flag != row.flag || (row.neutral && flag.value == row.neutral)) continue;
      MethodDecision decision{"phenomenological", fmt::format("{} is given: {}", row.flag, row.why), ""};
      if (row.approximates)
        decision.note = fmt::format("{}: found no --method, taken phenomenological instead of over, the default: {}",
                                    row.flag, row.why);
      return decision;
    }
  return {"over", "the default: exact", ""};
}

}  // namespace pellucid
