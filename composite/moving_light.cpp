#include "composite/moving_light.h"

#include <cstring>
#include <limits>

namespace pellucid {

void MovingLight::add(const Veil& veil, const Image<glm::vec4>* now, const Image<glm::vec4>& then) {
  ++passes_;
  if (!now || now == &then) return;
  for (std::size_t i = 0; i < then.size(); ++i) {
    const glm::vec3 lit((*now)[i]), before(then[i]);
    if (std::memcmp(&lit, &before, sizeof lit) == 0) continue;  // colours that are not numbers are equal too
    if (changed_.empty()) {
      changed_ = Image<glm::dvec3>(then.width(), then.height(), glm::dvec3(0.0));
      touched_ = Image<std::uint8_t>(then.width(), then.height(), 0);
    }
    const glm::vec3 passed = !veil.touched[i]  ? glm::vec3(1.0f)
                             : veil.scatters() ? veil.direct[i]
                                               : veil.transmission[i];
    changed_[i] += glm::dvec3(passed) * (glm::dvec3(lit) - glm::dvec3(before));
    touched_[i] = 1;
  }
}

void MovingLight::finish(Veil& mean) const {
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    if (!touched_[i]) continue;
    if (!mean.touched[i]) {
      mean.touched[i] = 1;
      mean.light[i] = glm::vec3(0.0f);
      mean.transmission[i] = glm::vec3(1.0f);
      mean.frontZ[i] = std::numeric_limits<float>::infinity();
      if (mean.scatters()) {
        mean.direct[i] = glm::vec3(1.0f);
        mean.applied[i] = glm::vec4(0.0f);
      }
    }
    mean.light[i] += glm::vec3(changed_[i] / static_cast<double>(passes_));
  }
}

}  // namespace pellucid
