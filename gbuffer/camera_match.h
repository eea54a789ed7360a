// Whether two cameras are one.
#pragma once
#include <string>

#include "gbuffer/camera.h"

namespace pellucid {

// Whether both show the world alike: place, direction and lens agree to what attributes in single precision keep of
// them. The clip range and the origin are not compared.
bool sameView(const Camera& a, const Camera& b);

// "at (0, 1, 4) along (0, 0, -1), focal (1.5, 2), centre (0, 0)", for messages; metres and NDC.
std::string viewText(const Camera& camera);

}  // namespace pellucid
