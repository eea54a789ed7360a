#include "tests/reference/lit_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/reference/bent_rays.h"

namespace pellucid::reference {
namespace {

constexpr double kLeastRoughness = 0.03;  // of highlights
constexpr double kNearest = 1e-6;         // metres: a lamp is no singularity
constexpr double kLeastCone = 1e-3;       // of the cosines between which a spot fades, KHR_lights_punctual

// Smith's masking of microfacets that know of one another's height, over 4 cosines.
double visibleOf(double cosEye, double cosLamp, double a2) {
  const double eye = cosLamp * std::sqrt(cosEye * cosEye * (1.0 - a2) + a2);
  const double lamp = cosEye * std::sqrt(cosLamp * cosLamp * (1.0 - a2) + a2);
  return 0.5 / (eye + lamp);
}

Vec3 interfaceColour(const Finished& surface, double cosine) {
  const Vec3 metal = surface.base + (1.0 - surface.base) * std::pow(1.0 - cosine, 5.0);
  return (1.0 - surface.metal) * interfacePart(surface, cosine) + surface.metal * metal;
}

Vec3 albedoOf(const Finished& surface, double cosEye) {
  return surface.base * ((1.0 - surface.metal) * (1.0 - surface.passes) * (1.0 - interfacePart(surface, cosEye)));
}

}  // namespace

double interfacePart(const Finished& surface, double cosine) {
  return surface.mirrors ? reflectedPart(cosine, surface.index) : 0.0;
}

Vec3 passedPart(const Finished& surface, double cosine) {
  return surface.base * (surface.passes * (1.0 - surface.metal) * (1.0 - interfacePart(surface, cosine)));
}

Vec3 reflectedEvenly(const Finished& surface, double cosine) {
  return albedoOf(surface, cosine) + interfaceColour(surface, cosine);
}

Sent sentBy(const PunctualLamp& lamp, const Vec3& point) {
  if (lamp.kind == PunctualLamp::Kind::sun)
    return {-lamp.along, lamp.intensity, std::numeric_limits<double>::infinity()};
  const Vec3 path = lamp.at - point;
  const double metres = glm::length(path), near = std::max(metres, kNearest);
  double part = 1.0 / (near * near);
  if (lamp.range > 0.0) part *= std::clamp(1.0 - std::pow(metres / lamp.range, 4.0), 0.0, 1.0);
  if (lamp.kind == PunctualLamp::Kind::spot) {
    const double inner = std::cos(lamp.innerCone), outer = std::cos(lamp.outerCone);
    const double within = (glm::dot(lamp.along, -path / metres) - outer) / std::max(kLeastCone, inner - outer);
    part *= std::pow(std::clamp(within, 0.0, 1.0), 2.0);
  }
  return {path / metres, lamp.intensity * part, metres};
}

Vec3 reflectedTowards(const Finished& surface, const Vec3& normal, const Vec3& toEye, const Vec3& toLamp) {
  const double cosLamp = glm::dot(normal, toLamp), cosEye = glm::dot(normal, toEye);
  if (!(cosLamp > 0.0)) return Vec3(0.0);
  const Vec3 half = glm::normalize(toEye + toLamp);
  const double a = std::pow(std::max(surface.roughness, kLeastRoughness), 2.0), a2 = a * a;
  const double cosHalf = std::clamp(glm::dot(normal, half), 0.0, 1.0);
  const double spread = 1.0 - cosHalf * cosHalf * (1.0 - a2);
  const double facets = a2 / (std::numbers::pi * spread * spread);
  const Vec3 mirrored = interfaceColour(surface, std::clamp(glm::dot(toEye, half), 0.0, 1.0));
  const Vec3 all = albedoOf(surface, cosEye) / std::numbers::pi + mirrored * facets * visibleOf(cosEye, cosLamp, a2);
  return cosLamp * all;
}

Vec3 leftByCaster(const Vec3& hidden, double cosine, double index) {
  const double s = std::clamp((index - 1.0) / 2.0, 0.0, 1.0);
  double gain = 1.0;
  if (s > 0.0) {
    const double g = 2.0 * std::clamp(1.0 - std::pow(cosine, 128.0 * s * s), 0.0, 1.0) - 1.0;
    gain = std::max(1.0 + g * std::pow(s, 0.2), 0.0);
  }
  return 1.0 - glm::min(gain * hidden, Vec3(1.0));
}

}  // namespace pellucid::reference
