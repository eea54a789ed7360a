#include "composite/pipeline/picture_depth.h"

#include <algorithm>

namespace pellucid {
namespace {

// Of an area and so many pixels around it, in pixels of the data window.
Window partOf(const Window& data, const Window& area, int around) {
  return {std::max(area.x0 - data.x0 - around, 0), std::max(area.y0 - data.y0 - around, 0),
          std::min(area.x1 - data.x0 + around, data.width()), std::min(area.y1 - data.y0 + around, data.height())};
}

Window inDisplay(const Window& part, const Window& data) {
  return {part.x0 + data.x0, part.y0 + data.y0, part.x1 + data.x0, part.y1 + data.y0};
}

bool holds(const Window& outer, const Window& inner) {
  return outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && outer.x1 >= inner.x1 && outer.y1 >= inner.y1;
}

// The part that is known, grown by another. Things that move ask for a little more in every frame of a shot: a side
// that gives way does so by a quarter of the part at once, so that few frames have to look at all of it again.
Window grown(const Window& known, const Window& part, const Window& data) {
  if (known.width() == 0) return part;
  const int ahead = std::max(known.width(), known.height()) / 4;
  const auto lower = [&](int from, int to) { return to < from ? std::max(std::min(to, from - ahead), 0) : from; };
  const auto upper = [&](int from, int to, int end) {
    return to > from ? std::min(std::max(to, from + ahead), end) : from;
  };
  return {lower(known.x0, part.x0), lower(known.y0, part.y0), upper(known.x1, part.x1, data.width()),
          upper(known.y1, part.y1, data.height())};
}

}  // namespace

const DepthPlanes& PictureDepth::planes(const GBuffer& gbuffer, const Camera& camera, const Window& area,
                                        Journal& journal) {
  const Window part = partOf(gbuffer.data, area, kEdgeSurroundings);
  if (!planes_ || !holds(planes_->part(), part)) {
    const Window all = grown(planes_ ? planes_->part() : Window{}, part, gbuffer.data);
    planes_ = journal.time("depth planes", [&] { return std::make_unique<DepthPlanes>(gbuffer, camera, all); });
  }
  return *planes_;
}

const std::vector<EdgePixel>& PictureDepth::edges(const GBuffer& gbuffer, const Camera& camera, const Window& area,
                                                  Journal& journal) {
  const Window part = partOf(gbuffer.data, area, 0);
  if (!holds(edgesOf_, part)) {
    const Window all = grown(edgesOf_, part, gbuffer.data);
    const DepthPlanes& known = planes(gbuffer, camera, inDisplay(all, gbuffer.data), journal);
    edges_ = journal.time("edges", [&] { return edgePixels(gbuffer, known, all); });
    edgesOf_ = all;
  }
  return edges_;
}

}  // namespace pellucid
