#include "composite/low_resolution.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "composite/denormals.h"
#include "shaders/low_resolution.h"

namespace pellucid {
namespace {

template <class Row>
void eachRow(int height, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

// The same lens, with NDC over the low view's window.
Camera cameraOver(const Camera& camera, const Window& display, const Window& covered) {
  Camera low = camera;
  const double ax = static_cast<double>(display.width()) / covered.width(),
               ay = static_cast<double>(display.height()) / covered.height();
  const double bx = (2.0 * (display.x0 - covered.x0) + display.width()) / covered.width() - 1.0,
               by = 1.0 - (2.0 * (display.y0 - covered.y0) + display.height()) / covered.height();
  low.focal = {camera.focal.x * ax, camera.focal.y * ay};
  low.centre = {camera.centre.x * ax + bx, camera.centre.y * ay + by};
  return low;
}

// Sums of one pixel, and what scattering adds to them.
struct Upsampled {
  shading::LowSums sums = shading::noTexels();
  glm::vec4 refraction{0.0f}, dispersion{0.0f};
  float refractionZ = 0.0f, diffuseZ = INFINITY;
};

class Upsampler {
 public:
  Upsampler(const OitPlanes& low, const LowView& view, glm::dvec2 sample, OitPlanes& planes)
      : low_(low),
        view_(view),
        planes_(planes),
        sample_(static_cast<float>(sample.x), static_cast<float>(sample.y)),
        texels_(low.data.width(), low.data.height()) {
    eachRow(texels_.height(), [this](int y) {
      for (int x = 0; x < texels_.width(); ++x)
        texels_.at(x, y) = shading::lowTexelOf(shading::unpackSums(low_.at(x, y)), low_.solid.at(x, y),
                                               low_.frontZ.at(x, y), low_.info.weight);
    });
    markNear();
  }

  void addTo(int x, int y) const {
    if (!near_.at(x / view_.factor, y / view_.factor)) return;
    const Upsampled up = around(x, y);
    const shading::LowLayer layer = shading::lowLayerOf(up.sums);
    // What only bends or spreads counts too, or nobody would look where to.
    const bool bends = low_.scatters() && (up.refraction.z > 0.0f || up.refraction.w > 0.0f);
    if (layer.shows || bends) add(layer, up.sums.nearestZ, x, y);
    if (low_.scatters()) addScatter(up, x, y);
  }

 private:
  // Blocks within reach of a texel that holds something.
  void markNear() {
    near_ = Image<std::uint8_t>(texels_.width(), texels_.height(), 0);
    for (int y = 0; y < texels_.height(); ++y)
      for (int x = 0; x < texels_.width(); ++x)
        if (low_.weight.at(x, y).a > 0.0f || low_.solid.at(x, y).a < INFINITY)
          eachTexel(x, y, shading::PLD_UPSAMPLE_REACH + 1, [this](int i, int j) { near_.at(i, j) = 1; });
  }

  Upsampled around(int x, int y) const {
    const float scale = 1.0f / static_cast<float>(view_.factor);
    const glm::vec2 place =
        shading::placeInTexels(glm::vec2(static_cast<float>(x), static_cast<float>(y)), sample_, scale);
    const int cx = static_cast<int>(std::floor(place.x + 0.5f)), cy = static_cast<int>(std::floor(place.y + 0.5f));
    const float opaqueZ = view_.opaqueZ.at(x, y);
    Upsampled up;
    const int tent = static_cast<int>(std::ceil(shading::PLD_UPSAMPLE_TENT));
    eachTexel(cx, cy, tent, [&](int i, int j) {
      const glm::vec2 offset(static_cast<float>(i) - place.x, static_cast<float>(j) - place.y);
      addTexel(up, i, j, opaqueZ, shading::upsampleShare(offset, opaqueZ, view_.gbuffer.viewZ.at(i, j)));
    });
    const float wide = shading::wideWeight(up.sums.share);
    if (wide > 0.0f)
      eachTexel(cx, cy, shading::PLD_UPSAMPLE_REACH, [&](int i, int j) {
        const glm::vec2 offset(static_cast<float>(i) - place.x, static_cast<float>(j) - place.y);
        addTexel(up, i, j, opaqueZ, shading::wideShare(offset, opaqueZ, view_.gbuffer.viewZ.at(i, j), wide));
      });
    return up;
  }

  template <class Each>
  void eachTexel(int cx, int cy, int reach, const Each& each) const {
    for (int j = std::max(cy - reach, 0); j <= std::min(cy + reach, texels_.height() - 1); ++j)
      for (int i = std::max(cx - reach, 0); i <= std::min(cx + reach, texels_.width() - 1); ++i) each(i, j);
  }

  void addTexel(Upsampled& up, int i, int j, float opaqueZ, float share) const {
    if (share <= 0.0f) return;
    const shading::LowTexel& texel = texels_.at(i, j);
    const float before = shading::standingBefore(texel, opaqueZ, view_.gbuffer.viewZ.at(i, j));
    up.sums = shading::addTexel(up.sums, texel, share, before);
    if (low_.scatters()) scatterTexel(up, i, j, share * before);
  }

  void scatterTexel(Upsampled& up, int i, int j, float share) const {
    up.refraction += share * low_.refraction.at(i, j);
    up.refractionZ += share * low_.light.at(i, j).a;
    if (low_.disperses()) up.dispersion += share * low_.dispersion.at(i, j);
    if (share > 0.0f) up.diffuseZ = std::min(up.diffuseZ, low_.diffuseZ.at(i, j));
  }

  void add(const shading::LowLayer& layer, float nearestZ, int x, int y) const {
    const shading::OitTargets added = shading::packSums(shading::lowLayerSums(layer, planes_.info.normalisation));
    planes_.radiance.at(x, y) += added.radiance;
    planes_.weight.at(x, y) += added.weight;
    planes_.opacity.at(x, y) += added.opacity;
    planes_.depth.at(x, y) += added.depth;
    planes_.light.at(x, y) += added.light;
    planes_.frontZ.at(x, y) = std::min(planes_.frontZ.at(x, y), nearestZ);
  }

  // Offsets and spreads of the low view are in texels.
  void addScatter(const Upsampled& up, int x, int y) const {
    const auto factor = static_cast<float>(view_.factor);
    const glm::vec4 mean = up.refraction / up.sums.share;
    planes_.refraction.at(x, y) += glm::vec4(factor * mean.x, factor * mean.y, mean.z, factor * factor * mean.w);
    planes_.light.at(x, y).a += up.refractionZ / up.sums.share;
    if (low_.disperses()) planes_.dispersion.at(x, y) += (factor / up.sums.share) * up.dispersion;
    if (mean.w > 0.0f) planes_.diffuseZ.at(x, y) = std::min(planes_.diffuseZ.at(x, y), up.diffuseZ);
  }

  const OitPlanes& low_;
  const LowView& view_;
  OitPlanes& planes_;
  glm::vec2 sample_;
  Image<shading::LowTexel> texels_;
  Image<std::uint8_t> near_;
};

}  // namespace

LowView lowViewOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid, const Camera& camera, int factor) {
  LowView view;
  view.factor = factor;
  view.opaqueZ = gbuffer.viewZ;
  for (std::size_t i = 0; i < solid.size(); ++i) view.opaqueZ[i] = std::min(view.opaqueZ[i], solid[i].a);
  const int width = (gbuffer.data.width() + factor - 1) / factor,
            height = (gbuffer.data.height() + factor - 1) / factor;
  view.gbuffer.display = view.gbuffer.data = {0, 0, width, height};
  view.gbuffer.depthPrecision = gbuffer.depthPrecision;
  view.gbuffer.viewZ = Image<float>(width, height, 0.0f);
  eachRow(height, [&](int y) {
    for (int py = y * factor; py < std::min((y + 1) * factor, gbuffer.data.height()); ++py)
      for (int px = 0; px < gbuffer.data.width(); ++px) {
        float& farthest = view.gbuffer.viewZ.at(px / factor, y);
        farthest = std::max(farthest, view.opaqueZ.at(px, py));
      }
  });
  const Window covered{gbuffer.data.x0, gbuffer.data.y0, gbuffer.data.x0 + width * factor,
                       gbuffer.data.y0 + height * factor};
  view.camera = cameraOver(camera, gbuffer.display, covered);
  return view;
}

void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, OitPlanes& planes) {
  if (low.scatters()) addScatterPlanes(planes);
  if (low.disperses()) addDispersionPlane(planes);
  const Upsampler upsampler(low, view, sample, planes);
  eachRow(planes.data.height(), [&](int y) {
    for (int x = 0; x < planes.data.width(); ++x) upsampler.addTo(x, y);
  });
}

}  // namespace pellucid
