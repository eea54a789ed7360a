// Whether two requests load the same shot, so that what is loaded serves both.
#pragma once
#include "composite/pipeline/request.h"

namespace pellucid::python {

bool sameShot(const ShotRequest& a, const ShotRequest& b);

}  // namespace pellucid::python
