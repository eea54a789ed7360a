#include "composite/pipeline/default_weight.h"

namespace pellucid {
namespace {

bool drawsMeans(const Request& request) {
  if (paintsBy<PaintSums>(request)) return true;
  const auto* listed = std::get_if<PaintListed>(&request.paint);
  return listed && listed->method.name == "weighted";
}

bool statesNoWeight(const SumsRequest& sums) {
  return !sums.weight && !sums.weightRange && !sums.weightReference && sums.weightFrom.empty();
}

}  // namespace

bool fitsWeight(const Request& request) {
  if (request.sums.fitWeight) return true;
  return statesNoWeight(request.sums) && drawsMeans(request) && request.tier != Tier::published &&
         request.heldOutBy.empty();
}

}  // namespace pellucid
