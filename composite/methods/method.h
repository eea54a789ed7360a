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

// What paints a method's veil.
enum class MethodKind {
  planes,      // sums of the transparent pass, resolved
  sorted,      // all fragments of a pixel, sorted and composited
  listed,      // `mix`, from all fragments of a pixel
  stochastic,  // random samples of a pixel, from lists or drawn on the device
};

// The number behind a method's name.
struct MethodOrder {
  const char* letter = "";
  int usual = 0, least = 0, most = 0;  // most 0: there is none
  bool even = false;
};

// One row: what asks for it and what it reads. The row is all that flags, help, plan and study know of a method.
struct Method {
  const char* name;
  MethodKind kind;
  const char* help;
  const char* source;          // where it is from
  const char* precision;       // of its sums: "half" (then one coverage for all channels), "float" or "double"
  LayerMethod mix = nullptr;   // null where no function of one pixel's list is the method
  int passes = 0;              // of geometry; 0: they depend on the shot
  int (*bits)(int) = nullptr;  // of sums a pixel by order, float, coloured opacity; null: they depend on the shot
  MethodOrder order = {};
  const char* variants = nullptr;  // behind the name: "basic|alpha|depth"
  // All that it keeps of a pixel are sums of one pass, so that planes of several passes add up to one picture.
  bool isSum = false;
  bool weighs = false;          // honours --weight, and --weight-range where the weight reads one
  bool normalises = false;      // honours --normalisation
  bool takesPublished = false;  // honours --precision published
  bool takesExact = true;       // honours --precision exact
  // Of every fragment of a pixel. Stochastic samples may be drawn on the device instead.
  bool needsLists() const { return kind == MethodKind::sorted || kind == MethodKind::listed; }
};

// Every method that --method takes.
const std::vector<Method>& allMethods();
// Those that a function of one pixel's list is: rows with `mix`.
const std::vector<Method>& methods();

struct ChosenMethod {
  const Method* method = nullptr;
  int order = 0;
  std::string name;  // "wavelet:2"
};
// "weighted", "wavelet:3", "mlab" (its default order). Nothing when the name is unknown or the order out of range, and
// for methods without `mix`.
std::optional<ChosenMethod> chooseMethod(const std::string& text);
// The row of any method by the text of --method: "over", "stochastic:alpha", "wavelet:3". Null when there is none.
const Method* methodNamed(const std::string& text);
// "sum, average, ..., wavelet:N (N 0 to 6), ..." of methods(), for messages.
std::string methodNames();
// "over, phenomenological, stochastic[:basic|alpha|depth], sum, ..." of allMethods().
std::string allMethodNames();
std::string sumMethodNames();  // of the rows that are sums
std::string methodsHelp();     // a line for every row

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

// Methods that others are made of; the table declares the rest.
LayerMix mixWeighted(const std::vector<MethodLayer>&, const MethodChoice&);
// The mean colour of WB13 listings 3 and 4, whose clamp keeps thin sums from blowing up and large ones from overflow.
//   sum, weight  of w C and w alpha, >= 0
glm::vec3 listingColour(const glm::vec3& sum, float weight);

// WB13 eqs. 3 and 4 from what planes keep of a pixel: sums of its layers' light and opacity.
LayerMix sumOf(const glm::dvec3& light, const glm::dvec3& opacity);
LayerMix averageOf(const glm::dvec3& light, const glm::dvec3& opacity, double layers);

}  // namespace pellucid
