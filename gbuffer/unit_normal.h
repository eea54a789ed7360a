// Normals as records hold them.
#pragma once
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid {

// Unit length, or 0 where an averaged normal is so short that it says nothing about any surface.
inline glm::vec3 unitNormal(glm::vec3 normal) {
  constexpr float kShortest = 0.5f;
  const float length = std::sqrt(glm::dot(normal, normal));
  return length >= kShortest && std::isfinite(length) ? normal / length : glm::vec3(0.0f);
}

}  // namespace pellucid
