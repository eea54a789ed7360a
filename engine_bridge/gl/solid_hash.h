// Names a solid plane: sums behind different solids must not be added.
#pragma once
#include <string>

#include "gbuffer/accum.h"

namespace pellucid::gl {

// Empty where no pixel has a solid; else 16 hexadecimal digits that depend on every bit of the plane.
std::string solidHash(const Image<glm::vec4>& solid);

}  // namespace pellucid::gl
