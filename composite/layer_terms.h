// What one fragment adds to the planes of a pixel: the one list of terms that every fold sums.
#pragma once
#include <array>
#include <limits>

#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "shaders/plane_layout.h"

namespace pellucid {

// By PlaneSum, packed as shaders/shared packs them.
using PlaneTerms = std::array<glm::vec4, kAddedSums>;

// Of these what scattering adds, from kFirstScatterSum on.
using ScatterTerms = std::array<glm::vec4, kScatterSums>;

struct LayerTerms {
  PlaneTerms sums{};
  float frontZ = std::numeric_limits<float>::infinity(),
        diffuseZ = frontZ;  // minima: of all layers, of those that diffuse
};

// The layer's own sums; what scattering adds to them.
//   place  of the fragment in its lists
void addSums(const FragmentLists& lists, std::size_t place, const shading::WeightSettings& weight, int normalisation,
             LayerTerms& terms);
void addScattering(const FragmentLists& lists, std::size_t place, LayerTerms& terms);

// The columns of a fragment that stands for all layers of such sums: the means that a pixel's planes tell.
void setColumns(FragmentLists& lists, std::size_t place, const ScatterTerms& sums);

// The planes that the terms go to, one pixel at a time. Those that are not kept are left out.
class PixelSums {
 public:
  explicit PixelSums(OitPlanes& planes);

  PlaneTerms at(std::size_t pixel) const;
  void set(std::size_t pixel, const PlaneTerms& sums) const;

 private:
  std::array<Image<glm::vec4>*, kAddedSums> images_;
};

}  // namespace pellucid
