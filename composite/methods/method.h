// Compositing methods that work from fragment lists, one file each, and the table of them. Double precision: what is
// measured is the method, not its storage.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "composite/veil.h"
#include "gbuffer/fragments.h"
#include "shaders/shading.h"

namespace pellucid {

// One transparent layer of a pixel. `record` is the fragment it comes from.
struct MethodLayer {
  glm::dvec3 light;    // premultiplied radiance C
  glm::dvec3 opacity;  // o = coverage (1 - t), per channel, [0,1]
  double z;            // planar metres
  const Fragment* record;
  // Its light adds instead of being averaged. MODEL section 3
  bool adds(int channel) const { return shading::isAdditive(record->coverage, record->transmission[channel]); }
};

struct MethodChoice {
  int order = 0;                   // R of wavelet, M of moments, K of mlab
  shading::WeightSettings weight;  // of the methods that weigh
  int normalisation = shading::PLD_NORMALISE_SPECTRAL;
};

// picture = light + transmission * background
struct LayerMix {
  glm::dvec3 light{0.0}, transmission{1.0};
};

//   layers  at least one, in the order submitted, none solid
using LayerMethod = LayerMix (*)(const std::vector<MethodLayer>& layers, const MethodChoice& choice);

struct Method {
  const char* name;
  LayerMethod mix;
  int orderDefault, orderLeast, orderMost;  // 0 where it has none
  bool evenOrder;
  bool weighs;             // honours --weight
  bool normalises;         // honours --normalisation
  const char* precision;   // of its sums: "half" (then one coverage for all channels), "float" or "double"
  int passes;              // of geometry
  int (*bits)(int order);  // of sums a pixel, float, coloured opacity
  const char* source;      // where it is from
};

const std::vector<Method>& methods();

struct ChosenMethod {
  const Method* method = nullptr;
  int order = 0;
  std::string name;  // "wavelet:2"
};
// "weighted", "wavelet:3", "mlab" (its default order). Nothing when the name is unknown or the order out of range.
std::optional<ChosenMethod> chooseMethod(const std::string& text);
// "sum, average, ..., wavelet:R, ..." for messages.
std::string methodNames();

// The layers of pixel i (row by row) that take part: in front of the solid, none solid themselves.
void layersOf(const FragmentLists& lists, std::size_t i, float solidZ, std::vector<MethodLayer>& layers);

// Writes the veil of the lists' window, which lies inside `data`.
void compositeBy(const ChosenMethod& chosen, const MethodChoice& choice, const FragmentLists& lists, const Window& data,
                 Veil& veil);

// Shared by methods that weigh by an estimated transmittance T in front of each layer: per channel
// sum(T C) / sum(T o) (1 - beta), and T C for light that adds. MODEL section 9
//   before  T of layer i, per channel, [0,1]
LayerMix mixByTransmittance(const std::vector<MethodLayer>& layers, const std::vector<glm::dvec3>& before);

// -ln(1 - o), capped as the methods that store absorbance need it.
glm::dvec3 absorbanceOf(const glm::dvec3& opacity);
glm::dvec3 productOfPassed(const std::vector<MethodLayer>& layers);  // beta

LayerMix mixSum(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixAverage(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixBlended(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixWeighted(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixUnsorted(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixFrontTail(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixWavelet(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixMoments(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixListing3(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixListing4(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixMonochrome(const std::vector<MethodLayer>&, const MethodChoice&);
// The mean colour of WB13 listings 3 and 4, whose clamp keeps thin sums from blowing up and large ones from overflow.
//   sum, weight  of w C and w alpha, >= 0
glm::vec3 listingColour(const glm::vec3& sum, float weight);
LayerMix mixMlab(const std::vector<MethodLayer>&, const MethodChoice&);

}  // namespace pellucid
