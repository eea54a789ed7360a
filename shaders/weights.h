// The depth weights of the blended sums, a row each. A new weight is its function in shaders/shared/weight.glsl and one
// more row at the end of this table: flags, help, files, the fit of `--weight auto` and the C library read it here.
#pragma once
#include <array>
#include <cstddef>

#include "shaders/shading.h"

namespace pellucid {

// What becomes of the picture when scene, camera and range grow by a common factor.
enum class WeightScale {
  free,    // nothing: all weights keep their ratios
  ranged,  // nothing, where --weight-range grows with the scene; the range of the camera does
  metres,  // another picture, unless --weight-reference grows with it: the function's constants are the paper's metres
};

// What WeightSettings::reference is to a weight.
enum class WeightReference {
  none,   // not read
  depth,  // a power of depth weighs 1 there. It cancels in the mean, so that sums of another one are the same but for a
          // factor: see referenceFactor()
  unit,   // of the function's constants, 1 metre as printed
};

struct DepthWeight {
  const char* name;  // as --weight and files of planes have it, without its parameter
  int kind;          // PLD_WEIGHT_*, which is the row's place and its value in the C library
  WeightScale scale;
  bool readsRange;  // rangeNear and rangeFar
  WeightReference reference;
  const char* parameter;  // letter of the number behind the name, "K" in power:K; null where there is none
  float least;            // of the parameter
  float fitMost;          // the fit tries parameters from `least` to this one
  bool perMetre;          // the parameter is one over a depth: the fit tries those of its probes
  bool fitted;            // tried by --weight auto
  const char* help;
};

inline constexpr std::array kDepthWeights{
    DepthWeight{"eq5", shading::PLD_WEIGHT_EQ5, WeightScale::ranged, true, WeightReference::none, nullptr, 0, 0, false,
                true,
                "McGuire and Mara 2017, eq. 5: falls with window depth over the range and with the layer's opacity"},
    DepthWeight{"eq7", shading::PLD_WEIGHT_EQ7, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0, false,
                true, "McGuire and Bavoil 2013, eq. 7 as printed, times the layer's opacity: for 0.1 to 500 m"},
    DepthWeight{"eq8", shading::PLD_WEIGHT_EQ8, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0, false,
                true, "eq. 8 as printed: the same range, steeper near the eye"},
    DepthWeight{"eq9", shading::PLD_WEIGHT_EQ9, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0, false,
                true, "eq. 9 as printed: falls beyond some 10 m only"},
    DepthWeight{"eq10", shading::PLD_WEIGHT_EQ10, WeightScale::ranged, true, WeightReference::none, nullptr, 0, 0,
                false, true, "eq. 10 as printed: the cube of what window depth over the range leaves"},
    DepthWeight{"eq7z", shading::PLD_WEIGHT_EQ7Z, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0,
                false, true, "eq. 7 by depth alone, without its second factor of opacity"},
    DepthWeight{"eq8z", shading::PLD_WEIGHT_EQ8Z, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0,
                false, true, "eq. 8 by depth alone"},
    DepthWeight{"eq9z", shading::PLD_WEIGHT_EQ9Z, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0,
                false, true, "eq. 9 by depth alone"},
    DepthWeight{"eq10z", shading::PLD_WEIGHT_EQ10Z, WeightScale::ranged, true, WeightReference::none, nullptr, 0, 0,
                false, true, "eq. 10 by depth alone"},
    DepthWeight{"power", shading::PLD_WEIGHT_POWER, WeightScale::free, false, WeightReference::depth, "K", 0, 32, false,
                true, "depth to the power of -K, over a reference depth"},
    DepthWeight{"uniform", shading::PLD_WEIGHT_UNIFORM, WeightScale::free, false, WeightReference::none, nullptr, 0, 0,
                false, true, "every layer alike, however far"},
    DepthWeight{"fig1", shading::PLD_WEIGHT_FIG1, WeightScale::metres, false, WeightReference::unit, nullptr, 0, 0,
                false, true, "McGuire and Bavoil 2013, figure 1: (depth + 5 m) to the power of -2"},
    DepthWeight{"fig6", shading::PLD_WEIGHT_FIG6, WeightScale::free, false, WeightReference::depth, nullptr, 0, 0,
                false, true, "figure 6: depth to the power of -6, times the square of the layer's opacity"},
    DepthWeight{"fig10", shading::PLD_WEIGHT_FIG10, WeightScale::metres, false, WeightReference::unit, "K", 0, 16, true,
                true, "figures 10 and 11: 10 / (1 + 10 (K depth)^5), K per metre; figure 11 has 0.01"},
    DepthWeight{"linear", shading::PLD_WEIGHT_LINEAR, WeightScale::ranged, true, WeightReference::none, nullptr, 0, 0,
                false, true, "section 3.4: how far depth is from the range's far end"},
};

constexpr bool placesAreKinds() {
  for (std::size_t i = 0; i < kDepthWeights.size(); ++i)
    if (kDepthWeights[i].kind != static_cast<int>(i)) return false;
  return true;
}
static_assert(placesAreKinds(), "a row stands at the place of its kind");

// Null for a kind that the table does not have.
constexpr const DepthWeight* depthWeightOf(int kind) {
  return kind >= 0 && kind < static_cast<int>(kDepthWeights.size()) ? &kDepthWeights[static_cast<std::size_t>(kind)]
                                                                    : nullptr;
}

}  // namespace pellucid
