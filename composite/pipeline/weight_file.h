// --weight-from: the weight of a picture or of planes that are there already, so that the frames of a sequence have
// one.
#pragma once
#include "composite/pipeline/request.h"

namespace pellucid {

// Of what composite and accumulate have written: --method, and weightText() of the weight where it weighs.
inline constexpr const char *kMethodAttribute = "pellucid:method", *kWeightAttribute = "pellucid:weight";

// The request with what the header of SumsRequest::weightFrom says in its place; itself where there is none. Planes
// that hold the request's out say it where it states no weight, so that both add up. Throws InputError for a file that
// cannot be read, MeaningError for one that says no weight.
Request weighedByFile(const Request& request);

}  // namespace pellucid
