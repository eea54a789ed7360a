#include "composite/low_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/low_resolution.h"

namespace pellucid {
namespace {

constexpr float kLeastContact = 4e-6f;  // of a depth of 32 bits: texels' mean depths are rounded as well
const double kCornerGrid = shading::PLD_UPSAMPLE_CORNERS;

// The pixel's plane tells the depth that the pixel has in this pass: neither a solid nor an edge's other surface.
bool shows(const DepthPlane& plane, glm::dvec2 sample, float opaqueZ, double contact) {
  const double z = plane.z(sample.x - 0.5, sample.y - 0.5);
  return std::abs(z - static_cast<double>(opaqueZ)) <= contact * z;
}

}  // namespace

LowSurface::LowSurface(const LowView& view, const Image<shading::LowTexel>& texels, glm::dvec2 sample)
    : view_(view),
      texels_(texels),
      sample_(sample),
      contact_(std::max(kLeastContact, 2.0f * view.gbuffer.depthPrecision)) {
  if (!view_.planes) return;
  own_ = Image<Own>(texels.width(), texels.height());
  tbb::parallel_for(0, own_.height(), [this](int j) {
    for (int i = 0; i < own_.width(); ++i)
      if (texels_.at(i, j).nearestZ < std::numeric_limits<float>::infinity()) {
        own_.at(i, j) = ownOf(i, j);
        if (shading::isThinTexel(texels_.at(i, j))) own_.at(i, j).layer = layerOf(i, j);
      }
  });
}

glm::dvec2 LowSurface::placeOf(int i, int j) const {
  return (glm::dvec2(i, j) + sample_) * static_cast<double>(view_.factor);
}

LowSurface::Pixel LowSurface::pixel(int x, int y) const {
  Pixel pixel{x, y, view_.opaqueZ.at(x, y), {}, false, {}};
  if (!std::isfinite(pixel.opaqueZ)) return pixel;
  if (!view_.planes) {
    pixel.around = aroundOf(x, y);
    return pixel;
  }
  pixel.plane = view_.planes->at(x, y);
  pixel.hasPlane = shows(pixel.plane, sample_, pixel.opaqueZ, static_cast<double>(contact_));
  return pixel;
}

LowSurface::Own LowSurface::ownOf(int i, int j) const {
  const glm::dvec2 place = placeOf(i, j);
  const int x = std::min(static_cast<int>(place.x), view_.opaqueZ.width() - 1),
            y = std::min(static_cast<int>(place.y), view_.opaqueZ.height() - 1);
  const Pixel shown = pixel(x, y);
  if (!shown.hasPlane) return {};
  const glm::dvec2 offset = place - (glm::dvec2(x, y) + 0.5);
  const double z = shown.plane.z(offset.x, offset.y);
  if (!std::isfinite(z)) return {};
  return {z, glm::dvec2(shown.plane.across, shown.plane.down), std::nullopt};
}

std::optional<double> LowSurface::layerSlope(int i, int j, int axis) const {
  const bool orthographic = view_.camera.orthographic;
  const auto linear = [&](float z) { return orthographic ? static_cast<double>(z) : 1.0 / static_cast<double>(z); };
  const double own = linear(texels_.at(i, j).z);
  PlaneValues values;
  for (int k = -kPlaneReach; k <= kPlaneReach; ++k) {
    const int u = axis == 0 ? i + k : i, v = axis == 0 ? j : j + k;
    const bool there =
        u >= 0 && v >= 0 && u < texels_.width() && v < texels_.height() && shading::isThinTexel(texels_.at(u, v));
    values[static_cast<std::size_t>(k + kPlaneReach)] =
        there ? linear(texels_.at(u, v).z) / own : std::numeric_limits<double>::quiet_NaN();
  }
  return slopeAlong(values, kLeastContact);
}

std::optional<DepthPlane> LowSurface::layerOf(int i, int j) const {
  const std::optional<double> across = layerSlope(i, j, 0), down = layerSlope(i, j, 1);
  if (!across || !down) return std::nullopt;
  return DepthPlane{static_cast<double>(texels_.at(i, j).z), *across, *down, view_.camera.orthographic};
}

// A slanted layer's depth changes where its corners are put on a grid.
//   perTexel  pixels or texels of the plane in a texel
float LowSurface::contact(const DepthPlane& plane, double perTexel) const {
  const double slope = std::abs(plane.across) + std::abs(plane.down);
  return contact_ + static_cast<float>(kCornerGrid * perTexel * slope);
}

// A surface that bends is met at the texel itself, as far as its bend can be why it leaves the pixel's plane.
float LowSurface::metAt(const Pixel& pixel, int i, int j) const {
  const glm::dvec2 offset = placeOf(i, j) - (glm::dvec2(pixel.x, pixel.y) + 0.5);
  double met = pixel.plane.z(offset.x, offset.y);
  const Own& own = own_.at(i, j);
  if (own.z > met) {
    const glm::dvec2 turns = glm::abs((own.slope - glm::dvec2(pixel.plane.across, pixel.plane.down)) * offset);
    if (own.z - met <= met * (turns.x + turns.y + static_cast<double>(contact_))) met = own.z;
  }
  return static_cast<float>(met);
}

// What a thin layer that its neighbours continue is where the pixel lies; nothing where it does not reach there.
std::optional<shading::LowTexel> LowSurface::followed(const Pixel& pixel, int i, int j) const {
  const std::optional<DepthPlane>& layer = own_.at(i, j).layer;
  if (!layer) return std::nullopt;
  const glm::dvec2 offset =
      (glm::dvec2(pixel.x, pixel.y) + sample_) / static_cast<double>(view_.factor) - sample_ - glm::dvec2(i, j);
  const double z = layer->z(offset.x, offset.y);
  if (!(z < 1e30)) return std::nullopt;
  shading::LowTexel there = texels_.at(i, j);
  there.z = there.nearestZ = static_cast<float>(z);
  return there;
}

shading::SurfaceNear LowSurface::aroundOf(int x, int y) const {
  const auto at = [&](int u, int v) {
    const bool inside = u >= 0 && v >= 0 && u < view_.opaqueZ.width() && v < view_.opaqueZ.height();
    return inside ? view_.opaqueZ.at(u, v) : 0.0f;
  };
  return shading::surfaceNear(view_.opaqueZ.at(x, y), glm::vec4(at(x - 2, y), at(x - 1, y), at(x + 1, y), at(x + 2, y)),
                              glm::vec4(at(x, y - 2), at(x, y - 1), at(x, y + 1), at(x, y + 2)));
}

// As shaders/gl/upsample.frag.
float LowSurface::beforeAround(const Pixel& pixel, const shading::LowTexel& texel, int i, int j) const {
  const float pixelsATexel = static_cast<float>(view_.factor);
  const glm::vec2 place = shading::placeInTexels(glm::vec2(static_cast<float>(pixel.x), static_cast<float>(pixel.y)),
                                                 glm::vec2(sample_), 1.0f / pixelsATexel);
  const glm::vec2 offset = (glm::vec2(static_cast<float>(i), static_cast<float>(j)) - place) * pixelsATexel;
  return shading::standingBefore(texel, shading::surfaceAt(pixel.around, pixel.opaqueZ, offset),
                                 view_.gbuffer.viewZ.at(i, j),
                                 shading::surfaceContact(pixel.around, pixelsATexel, offset));
}

float LowSurface::standingBefore(const Pixel& pixel, int i, int j, const shading::LowTexel& texel) const {
  const float tested = view_.gbuffer.viewZ.at(i, j);
  if (!view_.planes && std::isfinite(pixel.opaqueZ) && shading::isThinTexel(texel))
    return beforeAround(pixel, texel, i, j);
  if (!pixel.hasPlane || !shading::isThinTexel(texel))
    return shading::standingBefore(texel, pixel.opaqueZ, tested, shading::PLD_UPSAMPLE_CONTACT);
  if (const std::optional<shading::LowTexel> there = followed(pixel, i, j))
    return shading::standingBefore(*there, pixel.opaqueZ, std::numeric_limits<float>::infinity(),
                                   contact(*own_.at(i, j).layer, 1.0));
  return shading::standingBefore(texel, metAt(pixel, i, j), tested,
                                 contact(pixel.plane, static_cast<double>(view_.factor)));
}

}  // namespace pellucid
