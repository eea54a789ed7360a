#include "composite/layer_terms.h"

#include <algorithm>

#include "composite/fold.h"

namespace pellucid {
namespace {

glm::vec4& termOf(PlaneTerms& terms, PlaneSum sum) {
  return terms[static_cast<std::size_t>(sum)];
}

}  // namespace

void addSums(const FragmentLists& lists, std::size_t place, const shading::WeightSettings& weight, int normalisation,
             LayerTerms& terms) {
  const Fragment& fragment = lists.fragments[place];
  const shading::OitTargets sums = shading::packSums(shading::layerSums(layerFrom(fragment), weight, normalisation));
  termOf(terms.sums, PlaneSum::radiance) = sums.radiance;
  termOf(terms.sums, PlaneSum::weight) = sums.weight;
  termOf(terms.sums, PlaneSum::opacity) = sums.opacity;
  termOf(terms.sums, PlaneSum::depth) = sums.depth;
  termOf(terms.sums, PlaneSum::light) = sums.light;
  terms.frontZ = fragment.z;
}

void addScattering(const FragmentLists& lists, std::size_t place, LayerTerms& terms) {
  const shading::Layer layer = layerFrom(lists.fragments[place]);
  const shading::Scatter scatter = scatterFrom(lists.fragments[place]);
  const shading::ScatterTargets targets = shading::packScatter(layer, scatter);
  termOf(terms.sums, PlaneSum::refraction) = targets.refraction;
  termOf(terms.sums, PlaneSum::light).a = targets.refractionZ;
  terms.diffuseZ = targets.diffuseZ;
  if (lists.disperses())
    termOf(terms.sums, PlaneSum::dispersion) = shading::packDispersion(layer, scatter, lists.dispersion[place]);
}

void setColumns(FragmentLists& lists, std::size_t place, const ScatterTerms& sums) {
  const auto sumOf = [&](PlaneSum sum) { return sums[static_cast<std::size_t>(sum) - kFirstScatterSum]; };
  if (lists.disperses())
    lists.dispersion[place] = shading::dispersionOf(sumOf(PlaneSum::dispersion), sumOf(PlaneSum::refraction).z);
}

PixelSums::PixelSums(OitPlanes& planes) : images_(planes.sums()) {
  for (Image<glm::vec4>*& image : images_)
    if (image->empty()) image = nullptr;
}

PlaneTerms PixelSums::at(std::size_t pixel) const {
  PlaneTerms sums{};
  for (std::size_t k = 0; k < kAddedSums; ++k)
    if (images_[k]) sums[k] = (*images_[k])[pixel];
  return sums;
}

void PixelSums::set(std::size_t pixel, const PlaneTerms& sums) const {
  for (std::size_t k = 0; k < kAddedSums; ++k)
    if (images_[k]) (*images_[k])[pixel] = sums[k];
}

}  // namespace pellucid
