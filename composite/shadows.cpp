#include "composite/shadows.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "composite/antialias.h"
#include "gbuffer/depth_plane.h"
#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Image<glm::vec3> mappedVisibility(const ShadowMaps& maps, std::size_t light, const GBuffer& gbuffer,
                                  const Camera& camera, int samples, const AirPassed& air) {
  const Image<float>& viewZ = gbuffer.viewZ;
  Image<glm::vec3> result(viewZ.width(), viewZ.height(), glm::vec3(1.0f));
  const DepthPlanes planes(gbuffer, camera);
  tbb::parallel_for(0, viewZ.height(), [&](int y) {
    for (int x = 0; x < viewZ.width(); ++x) {
      const float z = viewZ.at(x, y);
      if (!std::isfinite(z)) continue;
      const DepthPlane plane = planes.at(x, y);
      glm::dvec3 sum(0.0);
      for (int i = 0; i < samples; ++i) {
        glm::dvec2 offset = samplePosition(i, samples) - 0.5;
        double depth = plane.z(offset.x, offset.y);
        if (!std::isfinite(depth) || depth <= kAtEye) {
          offset = glm::dvec2(0.0);
          depth = static_cast<double>(z);
        }
        const glm::dvec3 point = viewPoint(gbuffer, camera, glm::dvec2(x, y) + offset, depth);
        const glm::vec3 passed = maps.onOpaque(light, glm::vec3(point));
        sum += glm::dvec3(air ? passed * air(point) : passed);
      }
      result.at(x, y) = glm::vec3(sum / static_cast<double>(samples));
    }
  });
  return result;
}

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
