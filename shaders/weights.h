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
  metres,  // another picture: the function's constants are metres
};

struct DepthWeight {
  const char* name;  // as --weight and files of planes have it, without its parameter
  int kind;          // PLD_WEIGHT_*, which is the row's place and its value in the C library
  WeightScale scale;
  bool readsRange;        // rangeNear and rangeFar
  const char* parameter;  // letter of the number behind the name, "K" in power:K; null where there is none
  float least;            // of the parameter
  float fitMost;          // the fit tries parameters from 0 to this one
  bool fitted;            // tried by --weight auto
  const char* help;
};

inline constexpr std::array kDepthWeights{
    DepthWeight{"eq5", shading::PLD_WEIGHT_EQ5, WeightScale::ranged, true, nullptr, 0, 0, true,
                "McGuire and Mara 2017, eq. 5: falls with window depth over the range and with the layer's opacity"},
    DepthWeight{"eq7", shading::PLD_WEIGHT_EQ7, WeightScale::metres, false, nullptr, 0, 0, true,
                "McGuire and Bavoil 2013, eq. 7 as printed, times the layer's opacity: for 0.1 to 500 m"},
    DepthWeight{"eq8", shading::PLD_WEIGHT_EQ8, WeightScale::metres, false, nullptr, 0, 0, true,
                "eq. 8 as printed: the same range, steeper near the eye"},
    DepthWeight{"eq9", shading::PLD_WEIGHT_EQ9, WeightScale::metres, false, nullptr, 0, 0, true,
                "eq. 9 as printed: falls beyond some 10 m only"},
    DepthWeight{"eq10", shading::PLD_WEIGHT_EQ10, WeightScale::ranged, true, nullptr, 0, 0, true,
                "eq. 10 as printed: the cube of what window depth over the range leaves"},
    DepthWeight{"eq7z", shading::PLD_WEIGHT_EQ7Z, WeightScale::metres, false, nullptr, 0, 0, true,
                "eq. 7 by depth alone, without its second factor of opacity"},
    DepthWeight{"eq8z", shading::PLD_WEIGHT_EQ8Z, WeightScale::metres, false, nullptr, 0, 0, true,
                "eq. 8 by depth alone"},
    DepthWeight{"eq9z", shading::PLD_WEIGHT_EQ9Z, WeightScale::metres, false, nullptr, 0, 0, true,
                "eq. 9 by depth alone"},
    DepthWeight{"eq10z", shading::PLD_WEIGHT_EQ10Z, WeightScale::ranged, true, nullptr, 0, 0, true,
                "eq. 10 by depth alone"},
    DepthWeight{"power", shading::PLD_WEIGHT_POWER, WeightScale::free, false, "K", 0, 32, true,
                "depth to the power of -K"},
    DepthWeight{"uniform", shading::PLD_WEIGHT_UNIFORM, WeightScale::free, false, nullptr, 0, 0, true,
                "every layer alike, however far"},
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
