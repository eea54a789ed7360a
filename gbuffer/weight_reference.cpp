#include "gbuffer/weight_reference.h"

#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr double kFigure6Exponent = 6.0;

bool isOverDepth(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  return row && row->reference == WeightReference::depth;
}

// False where the sum leaves the range. Weights that became 0 would leave a mean of nothing; dark light may.
bool scale(float& sum, double factor, bool mayVanish = false) {
  const double scaled = static_cast<double>(sum) * factor, size = std::abs(scaled);
  if (size > static_cast<double>(std::numeric_limits<float>::max())) return false;
  if (!mayVanish && sum != 0.0f && size < static_cast<double>(std::numeric_limits<float>::min())) return false;
  sum = static_cast<float>(scaled);
  return true;
}

bool scaleLight(glm::vec4& light, double factor) {
  return scale(light.r, factor, true) && scale(light.g, factor, true) && scale(light.b, factor, true);
}

}  // namespace

bool readsReference(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  return row && row->reference != WeightReference::none;
}

bool sameButForReference(const shading::WeightSettings& a, const shading::WeightSettings& b) {
  return a.kind == b.kind && a.rangeNear == b.rangeNear && a.rangeFar == b.rangeFar && a.exponent == b.exponent &&
         (a.reference == b.reference || isOverDepth(a));
}

double referenceFactor(const shading::WeightSettings& from, const shading::WeightSettings& to) {
  if (from.reference == to.reference || !isOverDepth(from)) return 1.0;
  const double exponent = from.kind == shading::PLD_WEIGHT_FIG6 ? kFigure6Exponent : static_cast<double>(from.exponent);
  return std::pow(static_cast<double>(to.reference) / static_cast<double>(from.reference), exponent);
}

bool scaleWeights(OitPlanes& planes, double factor) {
  if (factor == 1.0) return true;
  if (planes.published()) return false;
  bool fits = true;
  for (std::size_t i = 0; i < planes.radiance.size() && fits; ++i) {
    glm::vec4& weight = planes.weight[i];
    fits = scaleLight(planes.radiance[i], factor) && scale(planes.radiance[i].a, factor) && scale(weight.r, factor) &&
           scale(weight.g, factor) && scale(weight.b, factor) && scale(planes.depth[i].a, factor);
  }
  return fits;
}

bool scaleWeights(RimPlanes& rims, double factor) {
  if (factor == 1.0 || rims.empty()) return true;
  bool fits = true;
  for (std::size_t i = 0; i < rims.averaged.size() && fits; ++i)
    fits = scaleLight(rims.averaged[i], factor) && scale(rims.averaged[i].a, factor) &&
           scale(rims.added[i].a, factor) && scale(rims.gradient[i].x, factor, true) &&
           scale(rims.gradient[i].y, factor, true);
  return fits;
}

}  // namespace pellucid
