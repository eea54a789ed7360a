#include "composite/pipeline/held_out_planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine_bridge/gl/solid_hash.h"
#include "gbuffer/errors.h"

namespace pellucid {

OtherSolids::OtherSolids(const std::vector<std::string>& paths, const GBuffer& gbuffer, const ColourSpace& space,
                         int passes) {
  for (const std::string& path : paths) {
    const std::vector<PassPlanes> others = readPasses(path);
    if (others.size() != static_cast<std::size_t>(passes))
      throw MeaningError(
          fmt::format("{}: --held-out-by: found {} passes, expected {}, as --aa says", path, others.size(), passes));
    for (std::size_t i = 0; i < others.size(); ++i) {
      const OitPlanes& planes = others[i].planes;
      if (planes.data != gbuffer.data || planes.display != gbuffer.display)
        throw MeaningError(
            fmt::format("{}: --held-out-by: found planes of another window, expected the picture's", path));
      if (!sameSpace(planes.info.space, space))
        throw MeaningError(fmt::format("{}: --held-out-by: found solids in the colour space {}, expected {}", path,
                                       planes.info.space.name, space.name));
      if (solids_.size() <= i) {
        solids_.push_back(planes.solid);
        continue;
      }
      for (std::size_t p = 0; p < planes.solid.size(); ++p)
        if (planes.solid[p].a < solids_[i][p].a) solids_[i][p] = planes.solid[p];
    }
  }
}

GBuffer OtherSolids::before(const GBuffer& gbuffer, int pass) const {
  GBuffer held = gbuffer;
  const Image<glm::vec4>& solid = solids_[static_cast<std::size_t>(pass)];
  for (std::size_t i = 0; i < solid.size(); ++i) held.viewZ[i] = std::min(held.viewZ[i], solid[i].a);
  return held;
}

void OtherSolids::addTo(OitPlanes& planes, int pass) const {
  const Image<glm::vec4>& solid = solids_[static_cast<std::size_t>(pass)];
  for (std::size_t i = 0; i < solid.size(); ++i)
    if (solid[i].a < planes.solid[i].a) planes.solid[i] = solid[i];
  planes.info.solidHash = gl::solidHash(planes.solid);
}

}  // namespace pellucid
