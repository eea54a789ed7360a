#include "composite/shadows.h"

#include <cmath>

namespace pellucid {
namespace {

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

ShadowCounts relight(const std::vector<ShadowedLight>& lights, Image<glm::vec4>& beauty, Image<std::uint8_t>& touched) {
  ShadowCounts counts;
  for (std::size_t i = 0; i < beauty.size(); ++i) {
    bool shadowed = false, whole = finite(glm::vec3(beauty[i]));
    glm::dvec3 taken(0.0);
    for (const ShadowedLight& light : lights) {
      const glm::vec3& v = (*light.visibility)[i];
      if (v == glm::vec3(1.0f)) continue;
      shadowed = true;
      whole = whole && finite((*light.light)[i]);
      taken += (glm::dvec3(1.0) - glm::dvec3(v)) * glm::dvec3((*light.light)[i]);
    }
    if (!shadowed) continue;
    if (!whole) {
      ++counts.nonFinite;
      continue;
    }
    if (taken == glm::dvec3(0.0)) continue;  // the light does not reach here
    const glm::dvec3 left = glm::dvec3(glm::vec3(beauty[i])) - taken;
    // A beauty may be negative where its filter rings; shadows do not make it so.
    const glm::dvec3 floor = glm::min(glm::dvec3(glm::vec3(beauty[i])), glm::dvec3(0.0));
    if (left.x < floor.x || left.y < floor.y || left.z < floor.z) ++counts.clamped;
    beauty[i] = glm::vec4(glm::vec3(glm::max(left, floor)), beauty[i].a);
    touched[i] = 1;
    ++counts.changed;
  }
  return counts;
}

ShadowCounts darken(const Image<glm::vec3>& multiplier, Image<glm::vec4>& beauty, Image<std::uint8_t>& touched) {
  ShadowCounts counts;
  for (std::size_t i = 0; i < beauty.size(); ++i) {
    if (multiplier[i] == glm::vec3(1.0f)) continue;
    if (!finite(glm::vec3(beauty[i]))) {
      ++counts.nonFinite;
      continue;
    }
    beauty[i] = glm::vec4(glm::vec3(beauty[i]) * multiplier[i], beauty[i].a);
    touched[i] = 1;
    ++counts.changed;
  }
  return counts;
}

}  // namespace pellucid
