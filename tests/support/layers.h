// Random layers in the reference's terms and as the records hold them.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/fragments.h"
#include "shaders/shading.h"
#include "tests/reference/sorted_over.h"
#include "tests/support/random.h"

namespace pellucid::test {

// Rounds to float first, so that both voices start from the same numbers.
inline reference::Layer rounded(reference::Layer layer) {
  layer.coverage = static_cast<double>(static_cast<float>(layer.coverage));
  layer.z = static_cast<double>(static_cast<float>(layer.z));
  for (std::size_t c = 0; c < 3; ++c) {
    layer.transmission[c] = static_cast<double>(static_cast<float>(layer.transmission[c]));
    layer.reflected[c] = static_cast<double>(static_cast<float>(layer.reflected[c]));
    layer.additive[c] = static_cast<double>(static_cast<float>(layer.additive[c]));
  }
  return layer;
}

inline shading::Layer shadingLayer(const reference::Layer& layer) {
  shading::Layer result;
  result.coverage = static_cast<float>(layer.coverage);
  result.z = static_cast<float>(layer.z);
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    result.radiance[c] = static_cast<float>(layer.coverage * layer.reflected[k] + layer.additive[k]);
    result.transmission[c] = static_cast<float>(layer.transmission[k]);
  }
  return result;
}

inline Fragment fragmentOf(const reference::Layer& layer) {
  const shading::Layer shaded = shadingLayer(layer);
  Fragment fragment{};
  fragment.radiance = shaded.radiance;
  fragment.coverage = shaded.coverage;
  fragment.transmission = shaded.transmission;
  fragment.z = shaded.z;
  return fragment;
}

inline shading::OitTargets addTargets(shading::OitTargets a, const shading::OitTargets& b) {
  a.radiance += b.radiance;
  a.weight += b.weight;
  a.opacity += b.opacity;
  a.depth += b.depth;
  a.light += b.light;
  return a;
}

inline shading::OitTargets noTargets() {
  shading::OitTargets none;
  none.radiance = none.weight = none.opacity = none.depth = none.light = glm::vec4(0.0f);
  return none;
}

// Sums and resolves layers in the order given, over a background.
inline glm::vec3 resolveLayers(const std::vector<reference::Layer>& layers, const shading::WeightSettings& weight,
                               int normalisation, glm::vec3 background, bool selfModulation = false) {
  shading::OitTargets sums = noTargets();
  for (const reference::Layer& layer : layers)
    sums = addTargets(sums, shading::packSums(shading::layerSums(shadingLayer(layer), weight, normalisation)));
  return shading::overBackground(shading::resolveSums(shading::unpackSums(sums), selfModulation), background);
}

inline shading::WeightSettings weightOf(int kind, float rangeNear = 0.1f, float rangeFar = 1000.0f,
                                        float exponent = 3.0f) {
  shading::WeightSettings settings;
  settings.kind = kind;
  settings.rangeNear = rangeNear;
  settings.rangeFar = rangeFar;
  settings.exponent = exponent;
  settings.reference = 1.0f;
  return settings;
}

}  // namespace pellucid::test
