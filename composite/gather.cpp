#include "composite/gather.h"

#include <algorithm>
#include <cmath>

#include "composite/spread_pyramid.h"

namespace pellucid {
namespace {

const float kReach2 = shading::PLD_GAUSSIAN_REACH * shading::PLD_GAUSSIAN_REACH;
// PT17 listing 3.
constexpr int kDiscStride = 2;
constexpr float kDiscLargest = 16.0f;

bool finite(const glm::vec4& colour) {
  return std::isfinite(colour.r + colour.g + colour.b + colour.a);
}

}  // namespace

Backdrop backdropOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid) {
  Backdrop backdrop{gbuffer.beauty, gbuffer.viewZ};
  for (std::size_t i = 0; i < solid.size(); ++i)
    if (std::isfinite(solid[i].a)) {
      backdrop.colour[i] = glm::vec4(glm::vec3(solid[i]), 1.0f);
      backdrop.z[i] = std::min(backdrop.z[i], solid[i].a);
    }
  return backdrop;
}

Lookups::Lookups(const Backdrop& backdrop, const OitPlanes& planes, const LookupSettings& settings)
    : backdrop_(backdrop),
      planes_(planes),
      settings_(settings),
      largestSpread_(std::hypot(static_cast<float>(planes.data.width()), static_cast<float>(planes.data.height()))) {
  if (settings.kernel != shading::PLD_DIFFUSE_GAUSSIAN || settings.exact) return;
  float most = 0.0f;
  for (std::size_t i = 0; i < planes.refraction.size(); ++i) most = std::max(most, planes.refraction[i].a);
  const float spread = shading::kernelSpread(most, largestSpread_);
  if (SpreadPyramid::levelFor(spread) > 0) pyramid_ = std::make_unique<SpreadPyramid>(backdrop, planes, spread);
}

Lookups::~Lookups() = default;

bool Lookups::scattersAt(int x, int y) const {
  const glm::vec4& refraction = planes_.refraction.at(x, y);
  return refraction.z > 0.0f || refraction.w > 0.0f;
}

shading::Path Lookups::pathAt(int x, int y) const {
  return shading::pathOf(planes_.refraction.at(x, y), planes_.light.at(x, y).a, planes_.diffuseZ.at(x, y));
}

Gathered Lookups::bilinear(glm::vec2 position, float nearestZ) const {
  const shading::Footprint footprint = shading::footprintAt(position);
  Gathered gathered;
  for (int k = 0; k < 4; ++k) {
    const int x = std::clamp(footprint.first.x + (k & 1), 0, backdrop_.z.width() - 1);
    const int y = std::clamp(footprint.first.y + (k >> 1), 0, backdrop_.z.height() - 1);
    const glm::vec4& colour = backdrop_.colour.at(x, y);
    const float share = footprint.share[k];
    if (share <= 0.0f || !finite(colour) || shading::standsInFront(backdrop_.z.at(x, y), nearestZ)) continue;
    gathered.colour += glm::dvec4(colour) * static_cast<double>(share);
    gathered.weight += static_cast<double>(share);
  }
  return gathered;
}

Gathered Lookups::gaussian(glm::vec2 centre, float variance, float scattererZ) const {
  const float spread = shading::kernelSpread(variance, largestSpread_);
  if (pyramid_ && SpreadPyramid::levelFor(spread) > 0) return pyramid_->gather(centre, spread, scattererZ);
  const float kernelVariance = spread * spread;
  const float radius = shading::PLD_GAUSSIAN_REACH * spread;
  const int x0 = static_cast<int>(std::ceil(centre.x - radius - 0.5f));
  const int x1 = static_cast<int>(std::floor(centre.x + radius - 0.5f));
  const int y0 = static_cast<int>(std::ceil(centre.y - radius - 0.5f));
  const int y1 = static_cast<int>(std::floor(centre.y + radius - 0.5f));
  const int lastX = backdrop_.z.width() - 1, lastY = backdrop_.z.height() - 1;
  thread_local std::vector<float> across;
  across.clear();
  for (int x = x0; x <= x1; ++x) {
    const float dx = static_cast<float>(x) + 0.5f - centre.x;
    across.push_back(shading::gaussianWeight(dx * dx, kernelVariance));
  }
  Gathered gathered;
  for (int y = y0; y <= y1; ++y) {
    const float dy = static_cast<float>(y) + 0.5f - centre.y;
    const float down = shading::gaussianWeight(dy * dy, kernelVariance);
    const int ty = std::clamp(y, 0, lastY);
    glm::vec4 rowColour(0.0f);
    float rowWeight = 0.0f;
    for (int x = x0; x <= x1; ++x) {
      const int tx = std::clamp(x, 0, lastX);
      const float dx = static_cast<float>(x) + 0.5f - centre.x;
      if (!shading::tapCounts(dx * dx + dy * dy, kernelVariance, planes_.refraction.at(tx, ty).w, kReach2)) continue;
      const glm::vec4& colour = backdrop_.colour.at(tx, ty);
      if (!finite(colour) || shading::standsInFront(backdrop_.z.at(tx, ty), scattererZ)) continue;
      const float weight = across[static_cast<std::size_t>(x - x0)];
      rowColour += weight * colour;
      rowWeight += weight;
    }
    gathered.colour += glm::dvec4(rowColour) * static_cast<double>(down);
    gathered.weight += static_cast<double>(rowWeight) * static_cast<double>(down);
  }
  return gathered;
}

Gathered Lookups::disc(glm::vec2 centre, float variance, float scattererZ) const {
  const int most = static_cast<int>(std::min(std::sqrt(variance), kDiscLargest)) / kDiscStride * kDiscStride;
  const int cx = static_cast<int>(std::floor(centre.x)), cy = static_cast<int>(std::floor(centre.y));
  Gathered gathered;
  for (int j = -most; j <= most; j += kDiscStride)
    for (int i = -most; i <= most; i += kDiscStride) {
      const int x = std::clamp(cx + i, 0, backdrop_.z.width() - 1), y = std::clamp(cy + j, 0, backdrop_.z.height() - 1);
      const float tapVariance = planes_.refraction.at(x, y).w;
      if (tapVariance <= 0.0f || !shading::tapCounts(static_cast<float>(i * i + j * j), variance, tapVariance, 1.0f))
        continue;
      const glm::vec4& colour = backdrop_.colour.at(x, y);
      if (!finite(colour) || shading::standsInFront(backdrop_.z.at(x, y), scattererZ)) continue;
      const auto weight = static_cast<double>(shading::discWeight(tapVariance));
      gathered.colour += glm::dvec4(colour) * weight;
      gathered.weight += weight;
    }
  return gathered;
}

glm::vec4 Lookups::at(int x, int y) const {
  const shading::Path path = pathAt(x, y);
  const glm::vec2 own(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  glm::vec2 place = own;
  Gathered tap;
  if (path.refracts) {
    place = own + path.offset;
    tap = bilinear(place, path.refractionZ);
  }
  if (tap.weight <= 0.0) {
    place = own;
    tap.colour = glm::dvec4(backdrop_.colour.at(x, y));
    tap.weight = 1.0;
  }
  const glm::vec4 undiffused(tap.colour / tap.weight);
  if (path.variance <= 0.0f) return undiffused;
  const Gathered spread = settings_.kernel == shading::PLD_DIFFUSE_DISC ? disc(place, path.variance, path.diffuseZ)
                                                                        : gaussian(place, path.variance, path.diffuseZ);
  if (spread.weight <= 0.0) return undiffused;
  const glm::vec4 diffused(spread.colour / spread.weight);
  const float share = shading::kernelShare(path.variance);
  if (share >= 1.0f || !finite(undiffused)) return diffused;
  return undiffused + share * (diffused - undiffused);
}

}  // namespace pellucid
