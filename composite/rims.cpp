#include "composite/rims.h"

#include <stdexcept>

#include "composite/denormals.h"
#include "composite/occlusion.h"

namespace pellucid {

std::size_t occludeRims(const RimPlanes& rims, const OccluderPlanes& occluders, int form, OitPlanes& planes) {
  if (occluders.data != planes.data || rims.averaged.size() != planes.radiance.size())
    throw std::logic_error("rims and occluders of another window than the sums'");
  const FlushDenormals flush;
  const glm::ivec2 size(planes.data.width(), planes.data.height());
  std::size_t found = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::vec4 averaged = rims.averaged.at(x, y), added = rims.added.at(x, y);
      if (!(averaged.a > 0.0f)) continue;
      ++found;
      const float z = added.a / averaged.a;
      const shading::OcclusionSearch search = shading::occlusionSearch(rims.gradient.at(x, y) / averaged.a);
      const float hidden = 1.0f - shading::occlusionFrom(neighboursOcclusion(occluders, {x, y}, search, z, form), form);
      planes.radiance.at(x, y) -= glm::vec4(hidden * glm::vec3(averaged), 0.0f);
      planes.light.at(x, y) -= glm::vec4(hidden * glm::vec3(added), 0.0f);
    }
  return found;
}

}  // namespace pellucid
