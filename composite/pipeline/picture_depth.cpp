#include "composite/pipeline/picture_depth.h"

#include <algorithm>

namespace pellucid {
namespace {

// Of an area and so many pixels around it, in pixels of the data window.
Window partOf(const Window& data, const Window& area, int around) {
  return {std::max(area.x0 - data.x0 - around, 0), std::max(area.y0 - data.y0 - around, 0),
          std::min(area.x1 - data.x0 + around, data.width()), std::min(area.y1 - data.y0 + around, data.height())};
}

bool holds(const Window& outer, const Window& inner) {
  return outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && outer.x1 >= inner.x1 && outer.y1 >= inner.y1;
}

// Both, and what lies between.
Window united(const Window& a, const Window& b) {
  if (a.width() == 0) return b;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

const DepthPlanes& PictureDepth::planes(const GBuffer& gbuffer, const Camera& camera, const Window& area,
                                        Journal& journal) {
  const Window part = partOf(gbuffer.data, area, kEdgeSurroundings);
  if (!planes_ || !holds(planes_->part(), part)) {
    const Window all = planes_ ? united(planes_->part(), part) : part;
    planes_ = journal.time("depth planes", [&] { return std::make_unique<DepthPlanes>(gbuffer, camera, all); });
  }
  return *planes_;
}

const std::vector<EdgePixel>& PictureDepth::edges(const GBuffer& gbuffer, const Camera& camera, const Window& area,
                                                  Journal& journal) {
  const Window part = partOf(gbuffer.data, area, 0);
  if (!holds(edgesOf_, part)) {
    const DepthPlanes& known = planes(gbuffer, camera, area, journal);
    edges_ = journal.time("edges", [&] { return edgePixels(gbuffer, known, part); });
    edgesOf_ = part;
  }
  return edges_;
}

}  // namespace pellucid
