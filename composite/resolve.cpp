#include "composite/resolve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/denormals.h"
#include "composite/methods/method.h"
#include "composite/wide_resolve.h"
#include "shaders/picture.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
const glm::vec4 kNoSolid(0.0f, 0.0f, 0.0f, kNothing);

// WB13 eqs. 3 and 4 from sums without a weight; a channel that is all but clear adds light and hides nothing there.
shading::Resolved byFormula(const shading::OitSums& sums, SumFormula formula) {
  const glm::dvec3 light = glm::dvec3(sums.numerator) + glm::dvec3(sums.light), opacity(sums.opacity);
  const LayerMix mix =
      formula == SumFormula::sum ? sumOf(light, opacity) : averageOf(light, opacity, static_cast<double>(sums.count));
  shading::Resolved resolved;
  resolved.transparent = glm::vec3(mix.light);
  resolved.transmission = glm::vec3(mix.transmission);
  return resolved;
}

shading::Resolved resolvedOf(const OitPlanes& planes, const shading::OitSums& sums, const ResolveSettings& settings) {
  if (planes.published())
    return shading::resolvePublished(sums.numerator, sums.denominator.r, sums.depth, settings.selfModulation);
  if (settings.formula != SumFormula::mean && sums.count > 0.0f) return byFormula(sums, settings.formula);
  return shading::resolveSums(sums, settings.selfModulation);
}

}  // namespace

SumFormula formulaOf(const std::string& method) {
  return method == "sum" ? SumFormula::sum : method == "average" ? SumFormula::average : SumFormula::mean;
}

Veil resolve(const OitPlanes& planes, const ResolveSettings& settings) {
  const int width = planes.data.width(), height = planes.data.height();
  const bool wide = !planes.published() && settings.formula == SumFormula::mean && !settings.selfModulation;
  Veil veil(width, height);
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = wide ? resolveWide(planes, y, veil) : 0; x < width; ++x) {
        const shading::OitSums sums = shading::unpackSums(planes.at(x, y));
        const glm::vec4 solid = planes.solid.at(x, y);
        const bool hasSolid = std::isfinite(solid.a);
        if (sums.count == 0.0f && !hasSolid) continue;
        shading::Resolved resolved = resolvedOf(planes, sums, settings);
        if (hasSolid) {
          resolved.transparent = shading::overBackground(resolved, glm::vec3(solid));
          resolved.transmission = glm::vec3(0.0f);
        }
        veil.light.at(x, y) = resolved.transparent;
        veil.transmission.at(x, y) = resolved.transmission;
        veil.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), solid.a);
        veil.touched.at(x, y) = 1;
      }
  });
  return veil;
}

void hideSolids(OitPlanes& planes) {
  if (!planes.scatters()) return;
  for (int y = 0; y < planes.data.height(); ++y)
    for (int x = 0; x < planes.data.width(); ++x)
      if (scattersAt(planes, x, y)) planes.solid.at(x, y) = kNoSolid;
}

bool hidesSolids(const FragmentLists& lists, const OitPlanes& planes) {
  if (!planes.scatters()) return false;
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  for (int y = 0; y < lists.solid.height(); ++y)
    for (int x = 0; x < lists.solid.width(); ++x)
      if (std::isfinite(lists.solid.at(x, y).a) && scattersAt(planes, left + x, top + y)) return true;
  return false;
}

void hideSolids(FragmentLists& lists, const OitPlanes& planes) {
  if (!planes.scatters()) return;
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  std::uint64_t kept = 0, next = 0;
  std::size_t pixel = 0;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x, ++pixel) {
      glm::vec4& solid = lists.solid[pixel];
      const bool hides = std::isfinite(solid.a) && scattersAt(planes, left + x, top + y);
      const std::uint64_t first = next;
      next = lists.offsets[pixel + 1];
      for (std::uint64_t i = first; i < next; ++i)
        if (!hides || lists.fragments[i].z <= solid.a) lists.fragments[kept++] = lists.fragments[i];
      if (hides) solid = kNoSolid;
      lists.offsets[pixel + 1] = kept;
    }
  lists.fragments.resize(kept);
}

void showThroughAt(const Lookups& lookups, int x, int y, Veil& veil, int top) {
  const glm::vec3 transmission = veil.transmission.at(x, y);
  const glm::vec4 background = lookups.at(x, top + y);
  veil.direct.at(x, y) = glm::vec3(0.0f);
  veil.applied.at(x, y) = glm::vec4(transmission * shading::throughOnly(transmission, glm::vec3(background)),
                                    shading::meanOf(transmission) * (1.0f - background.a));
}

void showThrough(const Lookups& lookups, Veil& veil, int top) {
  veil.addScatter();
  tbb::parallel_for(tbb::blocked_range<int>(0, veil.touched.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < veil.touched.width(); ++x) {
        if (!veil.touched.at(x, y) || !lookups.scattersAt(x, top + y)) continue;
        showThroughAt(lookups, x, y, veil, top);
      }
  });
}

Veil resolveOver(OitPlanes planes, const ResolveSettings& settings, const LookupSettings& lookup,
                 const GBuffer& background, const EdgeTexels* edges) {
  const glm::ivec2 place(planes.data.x0 - background.data.x0, planes.data.y0 - background.data.y0);
  PassBackdrop backdrops;
  const BackdropView backdrop = planes.scatters() ? backdrops.of(background, planes.solid, place) : BackdropView();
  hideSolids(planes);
  Veil veil = resolve(planes, settings);
  veil.place = place;
  if (planes.scatters()) showThrough(Lookups(backdrop, planes, lookup, place, edges), veil);
  return veil;
}

Picture compose(const Veil& veil, const GBuffer& background) {
  const int width = veil.touched.width(), height = veil.touched.height();
  Picture picture{background.beauty, Image<std::uint8_t>(background.beauty.width(), background.beauty.height(), 0)};
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < width; ++x) {
        if (!veil.touched.at(x, y)) continue;
        picture.touched.at(veil.place.x + x, veil.place.y + y) = veil.touched.at(x, y);
        glm::vec4& pixel = picture.rgba.at(veil.place.x + x, veil.place.y + y);
        shading::Resolved resolved;
        resolved.transparent = veil.light.at(x, y);
        resolved.transmission = veil.transmission.at(x, y);
        if (veil.scatters()) resolved.transmission = veil.direct.at(x, y);
        const glm::vec4 applied = veil.scatters() ? veil.applied.at(x, y) : glm::vec4(0.0f);
        pixel = shading::pictureOver(resolved, pixel, applied);
      }
  });
  return picture;
}

}  // namespace pellucid
