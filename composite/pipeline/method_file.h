// --method-from: the method of a picture that is there already, so that the frames of a sequence have one.
#pragma once
#include <map>
#include <string>

#include "composite/pipeline/plan.h"

namespace pellucid {

// What a header says of how its picture was painted, with the weight: attributes of `pellucid:`.
std::map<std::string, std::string> methodAttributes(const Plan& plan);

// The request with what the header of Request::methodFrom says in its place: method, weight where it weighs, tolerance
// and systems; itself where there is none. Throws InputError for a file that cannot be read, MeaningError for one that
// says no method, or one whose settings no header has (stochastic samples).
Request methodByFile(const Request& request);

}  // namespace pellucid
