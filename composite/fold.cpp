#include "composite/fold.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "composite/denormals.h"

namespace pellucid {

shading::Layer layerFrom(const Fragment& fragment) {
  shading::Layer layer;
  layer.radiance = fragment.radiance;
  layer.coverage = fragment.coverage;
  layer.transmission = fragment.transmission;
  layer.z = fragment.z;
  return layer;
}

shading::Scatter scatterFrom(const Fragment& fragment) {
  shading::Scatter scatter;
  scatter.offset = fragment.offset;
  scatter.variance = fragment.variance;
  return scatter;
}

bool anyScatters(const FragmentLists& lists) {
  return std::any_of(lists.fragments.begin(), lists.fragments.end(), [](const Fragment& fragment) {
    return fragment.variance > 0.0f || fragment.offset != glm::vec2(0.0f);
  });
}

bool takesPart(const Fragment& fragment, const glm::vec4& solid) {
  return !(fragment.z > solid.a) && !shading::isSolid(fragment.coverage, fragment.transmission);
}

void copySolids(const FragmentLists& lists, OitPlanes& planes) {
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  for (int y = 0; y < lists.window.height(); ++y)
    std::copy(lists.solid.row(y), lists.solid.row(y) + lists.window.width(), &planes.solid.at(left, top + y));
}

namespace {

void foldScatterPixel(const FragmentLists& lists, std::size_t pixel, const glm::vec4& solid, int px, int py,
                      OitPlanes& planes) {
  glm::vec4 refraction = planes.refraction.at(px, py);
  float refractionZ = planes.light.at(px, py).a, diffuseZ = planes.diffuseZ.at(px, py);
  for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
    const Fragment& fragment = lists.fragments[i];
    if (!takesPart(fragment, solid)) continue;
    const shading::ScatterTargets added = shading::packScatter(layerFrom(fragment), scatterFrom(fragment));
    refraction += added.refraction;
    refractionZ += added.refractionZ;
    diffuseZ = added.diffuseZ < diffuseZ ? added.diffuseZ : diffuseZ;
    if (lists.disperses())
      planes.dispersion.at(px, py) +=
          shading::packDispersion(layerFrom(fragment), scatterFrom(fragment), lists.dispersion[i]);
  }
  planes.refraction.at(px, py) = refraction;
  planes.light.at(px, py).a = refractionZ;
  planes.diffuseZ.at(px, py) = diffuseZ;
}

}  // namespace

void foldScattering(const FragmentLists& lists, OitPlanes& planes) {
  copySolids(lists, planes);
  if (!anyScatters(lists)) return;
  addScatterPlanes(planes);
  if (lists.disperses()) addDispersionPlane(planes);
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        foldScatterPixel(lists, pixel, lists.solid.at(x, y), left + x, top + y, planes);
      }
  });
}

void foldFragments(const FragmentLists& lists, const shading::WeightSettings& weight, int normalisation,
                   OitPlanes& planes) {
  const int left = lists.window.x0 - planes.data.x0, top = lists.window.y0 - planes.data.y0;
  tbb::parallel_for(tbb::blocked_range<int>(0, lists.window.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        const int px = left + x, py = top + y;
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(x);
        shading::OitTargets sums = planes.at(px, py);
        float front = planes.frontZ.at(px, py);
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
          const Fragment& fragment = lists.fragments[i];
          if (!takesPart(fragment, lists.solid.at(x, y))) continue;
          const shading::OitTargets added =
              shading::packSums(shading::layerSums(layerFrom(fragment), weight, normalisation));
          sums.radiance += added.radiance;
          sums.weight += added.weight;
          sums.opacity += added.opacity;
          sums.depth += added.depth;
          sums.light += added.light;
          front = fragment.z < front ? fragment.z : front;
        }
        planes.radiance.at(px, py) = sums.radiance;
        planes.weight.at(px, py) = sums.weight;
        planes.opacity.at(px, py) = sums.opacity;
        planes.depth.at(px, py) = sums.depth;
        planes.light.at(px, py) = sums.light;
        planes.frontZ.at(px, py) = front;
      }
  });
  foldScattering(lists, planes);
}

}  // namespace pellucid
