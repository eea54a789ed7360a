#include "composite/pipeline/painters/system_canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "composite/deep/placed_sums.h"

namespace pellucid {
namespace {

void putSolid(const glm::vec4& solid, bool lookedUp, Veil& veil, std::size_t at) {
  veil.touched[at] = 1;
  veil.frontZ[at] = std::min(veil.frontZ[at], solid.a);
  if (lookedUp) return;
  veil.light[at] += veil.transmission[at] * glm::vec3(solid);
  veil.transmission[at] = glm::vec3(0.0f);
}

}  // namespace

SystemCanvas::SystemCanvas(const LitPicture& picture)
    : gbuffer_(*picture.gbuffer), centres_(*picture.centres), edges_(picture.edges), deep_(picture.deepOpaque) {
  if (deep_) places_ = rowOfPlaces(*deep_);
}

Veil SystemCanvas::empty() const {
  const Window window = deep_ ? placesWindow(*deep_) : gbuffer_.data;
  return Veil(window.width(), window.height());
}

void SystemCanvas::mix(const FragmentLists& lists, const Mix& mix, Veil& veil) {
  if (!deep_) {
    mix(lists, gbuffer_.data, veil);
    return;
  }
  const HeldOutRow row = holdOut(lists, *deep_);
  const Window& entries = row.lists.window;
  if (entries.width() == 0) return;
  Veil own(entries.width(), 1);
  mix(row.lists, entries, own);
  for (std::size_t entry = 0; entry < row.place.size(); ++entry) {
    const std::size_t place = row.place[entry];
    veil.touched[place] = own.touched[entry];
    veil.light[place] = own.light[entry];
    veil.transmission[place] = own.transmission[entry];
    veil.frontZ[place] = own.frontZ[entry];
    places_.bends[place] |= row.bends[entry];
  }
}

void SystemCanvas::addSolids(const OitPlanes& planes, Veil& veil) const {
  for (int y = 0; y < gbuffer_.data.height(); ++y)
    for (int x = 0; x < gbuffer_.data.width(); ++x) {
      const glm::vec4 solid = planes.solid.at(x, y);
      if (!std::isfinite(solid.a)) continue;
      const bool lookedUp = planes.scatters() && scattersAt(planes, x, y);
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer_.data.width()) + static_cast<std::size_t>(x);
      if (!deep_) {
        putSolid(solid, lookedUp, veil, pixel);
        continue;
      }
      for (std::uint64_t k = deep_->offsets[pixel]; k <= deep_->offsets[pixel + 1]; ++k)
        if (k == deep_->offsets[pixel + 1] || solid.a <= deep_->samples[k].z * (1.0f + deep_->depthPrecision))
          putSolid(solid, lookedUp, veil, k + pixel);
    }
}

Veil SystemCanvas::finish(const OitPlanes& planes, const LookupSettings& lookup, Veil veil) const {
  const bool scatters = planes.scatters();
  if (deep_) return veilOfPlaces(places_, veil, scatters ? &planes : nullptr, lookup, *deep_, centres_);
  if (scatters) {
    const Backdrop backdrop = backdropOf(centres_, planes.solid);
    showThrough(Lookups(backdrop, planes, lookup, glm::ivec2(0), edges_), veil);
  }
  return veil;
}

}  // namespace pellucid
