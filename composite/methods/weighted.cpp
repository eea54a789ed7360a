// WB13 eqs. 5 and 6: the very sums and resolve of the GL pass, in list order.
#include "composite/methods/method.h"

namespace pellucid {
namespace {

void add(shading::OitTargets& sums, const shading::OitTargets& added) {
  sums.radiance += added.radiance;
  sums.weight += added.weight;
  sums.opacity += added.opacity;
  sums.depth += added.depth;
  sums.light += added.light;
}

LayerMix mixSums(const std::vector<MethodLayer>& layers, const shading::WeightSettings& weight, int normalisation) {
  shading::OitTargets sums;
  sums.radiance = sums.weight = sums.opacity = sums.depth = sums.light = glm::vec4(0.0f);
  for (const MethodLayer& layer : layers) {
    shading::Layer shaded;
    shaded.radiance = layer.record->radiance;
    shaded.coverage = layer.record->coverage;
    shaded.transmission = layer.record->transmission;
    shaded.z = layer.record->z;
    add(sums, shading::packSums(shading::layerSums(shaded, weight, normalisation)));
  }
  const shading::Resolved resolved = shading::resolveSums(shading::unpackSums(sums), false);
  return {glm::dvec3(resolved.transparent), glm::dvec3(resolved.transmission)};
}

}  // namespace

LayerMix mixWeighted(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  return mixSums(layers, choice.weight, choice.normalisation);
}

LayerMix mixBlended(const std::vector<MethodLayer>& layers, const MethodChoice&) {
  return mixSums(layers, {shading::PLD_WEIGHT_UNIFORM, 0.1f, 1000.0f, 0.0f, 1.0f}, shading::PLD_NORMALISE_SPECTRAL);
}

}  // namespace pellucid
