// Whether a colour is made of numbers.
#pragma once
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid {

inline bool isFinite(const glm::dvec3& colour) {
  return std::isfinite(colour.r) && std::isfinite(colour.g) && std::isfinite(colour.b);
}
inline bool isFinite(const glm::vec4& colour) {
  return isFinite(glm::dvec3(colour)) && std::isfinite(colour.a);
}

}  // namespace pellucid
