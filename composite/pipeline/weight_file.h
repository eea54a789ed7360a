// --weight-from: the weight of a picture or of planes that are there already, so that the frames of a sequence have
// one.
#pragma once
#include "composite/pipeline/request.h"

namespace pellucid {

// Of files that a weighing method has written: weightText() of its weight.
inline constexpr const char* kWeightAttribute = "pellucid:weight";

// The request with what the header of SumsRequest::weightFrom says in its place; itself where there is none. Throws
// InputError for a file that cannot be read, MeaningError for one that says no weight.
Request weighedByFile(const Request& request);

}  // namespace pellucid
