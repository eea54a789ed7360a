// The weight where none is stated.
#pragma once
#include "composite/pipeline/request.h"

namespace pellucid {

// Whether the weight is fitted to the shot: where it is asked for, and where the phenomenological or weighted sums of a
// whole shot are drawn and nothing is said of a weight. Else it is eq5, that of the papers: with a range, whose weight
// it is, in the published tier, which is the papers' picture, in passes for each system, and for planes that hold each
// other out, which take that of the other planes. A pure function of the request.
bool fitsWeight(const Request& request);
// Whether that of some system is.
bool fitsAny(const PaintSystems& systems);
// Whether a power of depth needs to know where the layers begin.
bool asksDepths(const Request& request);

}  // namespace pellucid
