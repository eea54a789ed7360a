// What is known of the depth of a shot's picture: its planes and its edges, of the part that somebody has asked about.
#pragma once
#include <memory>
#include <vector>

#include "composite/edges.h"
#include "composite/pipeline/journal.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {

class PictureDepth {
 public:
  // Of an area in display coordinates, of which more may be known. What was given before for a smaller one holds no
  // longer. The picture and its camera are the same at every call.
  const DepthPlanes& planes(const GBuffer& gbuffer, const Camera& camera, const Window& area, Journal& journal);
  const std::vector<EdgePixel>& edges(const GBuffer& gbuffer, const Camera& camera, const Window& area,
                                      Journal& journal);

 private:
  std::unique_ptr<DepthPlanes> planes_;
  Window edgesOf_;  // in pixels of the data window; of no pixel as long as nobody has asked
  std::vector<EdgePixel> edges_;
};

}  // namespace pellucid
