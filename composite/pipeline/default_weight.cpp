#include "composite/pipeline/default_weight.h"

#include <algorithm>

#include "shaders/weights.h"

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

bool overDepth(const std::optional<shading::WeightSettings>& weight) {
  const DepthWeight* row = weight ? depthWeightOf(weight->kind) : nullptr;
  return row && row->reference == WeightReference::depth;
}

}  // namespace

bool fitsWeight(const Request& request) {
  if (request.sums.fitWeight) return true;
  return statesNoWeight(request.sums) && drawsMeans(request) && request.tier != Tier::published &&
         request.heldOutBy.empty();
}

bool fitsAny(const PaintSystems& systems) {
  return std::any_of(systems.weights.begin(), systems.weights.end(),
                     [](const SystemWeight& each) { return !each.weight; });
}

bool asksDepths(const Request& request) {
  if (request.sums.weightReference) return false;
  if (fitsWeight(request) || overDepth(request.sums.weight)) return true;
  const auto* systems = std::get_if<PaintSystems>(&request.paint);
  if (!systems) return false;
  return fitsAny(*systems) ||
         std::any_of(systems->weights.begin(), systems->weights.end(),
                     [](const SystemWeight& each) { return !each.whole && overDepth(each.weight); });
}

}  // namespace pellucid
