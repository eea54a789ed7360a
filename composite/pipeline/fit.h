// --weight auto: the weight that errs least on this shot.
#pragma once
#include "composite/pipeline/painter.h"

namespace pellucid {

// Fits the weight to the sorted truth on probe pixels at their centres, and notes what was chosen.
//   sample  with the light
shading::WeightSettings fittedWeight(const PaintContext& context, const PassSettings& sample);

// The flags that ask for this weight, with every bit of it.
std::string weightFlags(const shading::WeightSettings& weight);

}  // namespace pellucid
