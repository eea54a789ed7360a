#include "composite/pipeline/cheapest.h"

#include <fmt/format.h>

#include "composite/pipeline/refusals.h"

namespace pellucid {

Request bySums(const Request& request) {
  Request sums = request;
  sums.method = "phenomenological";
  sums.paint = PaintSums{};
  sums.decided.reset();
  return sums;
}

Request byTruth(const Request& request) {
  Request truth = request;
  truth.method = "over";
  truth.paint = PaintSorted{};
  truth.decided.reset();
  dropUnread(truth);
  return truth;
}

bool sumsMayDo(const Choice& choice) {
  return choice.layers >= kLayersOfSums && choice.onProbes <= 1.0;
}

bool sumsDo(const Choice& choice) {
  return sumsMayDo(choice) && choice.measured && *choice.measured <= 1.0;
}

std::string reasonOf(const Choice& choice) {
  if (choice.layers < kLayersOfSums)
    return fmt::format("over: with {:.2f} layers a pixel it is as cheap as sums, and exact", choice.layers);
  if (!sumsMayDo(choice))
    return fmt::format("over: the sums err by {:.3g} times the tolerance of {} on probes", choice.onProbes,
                       choice.tolerance);
  if (!sumsDo(choice))
    return fmt::format("over: the sums err by {:.3g} times the tolerance of {}, by {:.3g} times on probes",
                       choice.measured.value_or(0.0), choice.tolerance, choice.onProbes);
  return fmt::format("phenomenological: no pixel errs by more than {:.3f} of the tolerance of {}", *choice.measured,
                     choice.tolerance);
}

}  // namespace pellucid
