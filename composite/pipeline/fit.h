// --weight auto: the weight that errs least on this shot.
#pragma once
#include "composite/pipeline/painter.h"
#include "composite/pipeline/pass_picture.h"

namespace pellucid {

inline constexpr const char* kFitStage = "fit weight";  // of the journal

// Fits the weight to the sorted truth on probe pixels, and notes what was chosen.
//   moving  the picture of `context`
//   sample  with the light
//   flag  that asks for it, for the note
shading::WeightSettings fittedWeight(const PaintContext& context, PassPicture& moving, const PassSettings& sample,
                                     const std::string& flag = "--weight auto");

// The flags that ask for this weight, with every bit of it.
std::string weightFlags(const shading::WeightSettings& weight);

}  // namespace pellucid
