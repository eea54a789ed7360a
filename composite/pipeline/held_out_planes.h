// Planes that are to be added to others with solids of their own: each must be held out by the solids of all.
#pragma once
#include <string>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "gbuffer/planes_io.h"

namespace pellucid {

// Nearest solids of each pass of some files of planes.
class OtherSolids {
 public:
  // Throws what readPasses() throws, and MeaningError for planes of another window, colour space or number of
  // passes.
  OtherSolids(const std::vector<std::string>& paths, const GBuffer& gbuffer, const ColourSpace& space, int passes);
  bool empty() const { return solids_.empty(); }
  // The picture's depth with the solids of a pass in front of it.
  GBuffer before(const GBuffer& gbuffer, int pass) const;
  // Gives planes that were accumulated over that picture the nearest solid of all.
  void addTo(OitPlanes& planes, int pass) const;

 private:
  std::vector<Image<glm::vec4>> solids_;  // per pass: rgb, planar z, +inf for none
};

}  // namespace pellucid
