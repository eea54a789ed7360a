#include "samples/generate/studio.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "samples/generate/hash.h"
#include "samples/generate/shapes.h"

namespace pellucid::samples {
namespace {

constexpr int kEdge = 4;         // a pixel has kEdge x kEdge strata
constexpr int kAmbientRays = 4;  // for each of them
constexpr double kFar = 1e6;     // metres: as far as the sun's shadow is looked for
constexpr double kPi = glm::pi<double>();

struct Basis {
  glm::dvec3 x, y, z;
  explicit Basis(glm::dvec3 axis) : z(axis) {
    const glm::dvec3 helper = std::abs(z.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    x = glm::normalize(glm::cross(helper, z));
    y = glm::cross(z, x);
  }
  glm::dvec3 world(double a, double b, double c) const { return a * x + b * y + c * z; }
};

// Uniform in the unit disc.
glm::dvec2 inDisc(glm::dvec2 u) {
  const double radius = std::sqrt(u.x), angle = 2.0 * kPi * u.y;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// One of count x count strata of the unit square, shifted by the pixel's own offset (Cranley-Patterson).
glm::dvec2 stratum(int index, int count, glm::dvec2 offset) {
  const glm::dvec2 u = (glm::dvec2(index % count, index / count) + 0.5) / static_cast<double>(count) + offset;
  return u - glm::floor(u);
}

struct PixelSeed {
  glm::dvec2 sun, ambient;
  PixelSeed(int x, int y) {
    const auto a = static_cast<std::uint32_t>(x), b = static_cast<std::uint32_t>(y);
    sun = {unit(hash(a, b, 0)), unit(hash(a, b, 1))};
    ambient = {unit(hash(a, b, 2)), unit(hash(a, b, 3))};
  }
};

// Part of the hemisphere above a point that is open. Cosine weighted, [0,1]
double openness(const Studio& studio, glm::dvec3 point, glm::dvec3 normal, int sample, const PixelSeed& seed) {
  const Basis basis(normal);
  int open = 0;
  for (int k = 0; k < kAmbientRays; ++k) {
    const glm::dvec2 d = inDisc(stratum(sample * kAmbientRays + k, 8, seed.ambient));
    const double up = std::sqrt(std::max(0.0, 1.0 - glm::dot(d, d)));
    if (!anyHit(studio.shapes, {point, basis.world(d.x, d.y, up)}, studio.ambientReach)) ++open;
  }
  return static_cast<double>(open) / kAmbientRays;
}

glm::dvec3 sunlight(const Studio& studio, glm::dvec3 point, glm::dvec3 normal, int sample, const PixelSeed& seed) {
  const glm::dvec2 d = studio.sunRadius * inDisc(stratum(sample, kEdge, seed.sun));
  const glm::dvec3 toLight = glm::normalize(Basis(studio.toSun).world(d.x, d.y, 1.0));
  const double cosine = glm::dot(normal, toLight);
  if (cosine <= 0.0 || anyHit(studio.shapes, {point, toLight}, kFar)) return glm::dvec3(0.0);
  return studio.sunIrradiance * cosine;
}

struct Lit {
  glm::dvec3 radiance, sun;  // sun: its part
  double open;               // [0,1]
};

Lit shade(const Studio& studio, const Ray& ray, int sample, const PixelSeed& seed) {
  const auto hit = nearestHit(studio.shapes, ray);
  if (!hit) return {studio.sky ? studio.sky(ray.direction) : glm::dvec3(0.0), glm::dvec3(0.0), 1.0};
  const glm::dvec3 normal = glm::dot(hit->normal, ray.direction) > 0.0 ? -hit->normal : hit->normal;
  const glm::dvec3 point = ray.origin + hit->distance * ray.direction + 1e-5 * normal;
  const double open = openness(studio, point, normal, sample, seed);
  const glm::dvec3 albedo = hit->shape->albedo(point);
  const glm::dvec3 sun = sunlight(studio, point, normal, sample, seed) / kPi;
  return {albedo * (sun + studio.ambient * open), albedo * sun, open};
}

}  // namespace

OpaquePicture render(const Studio& studio, const View& view) {
  const Camera camera = view.camera();
  const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(camera.viewFromWorld));
  const auto rayThrough = [&](double px, double py) {
    const double ndcX = 2.0 * px / view.width - 1.0, ndcY = 1.0 - 2.0 * py / view.height;
    const glm::dvec3 inView(ndcX / camera.focal.x, ndcY / camera.focal.y, -1.0);
    return Ray{view.eye, glm::normalize(worldFromView * inView)};
  };
  OpaquePicture out;
  out.beauty = Image<glm::vec3>(view.width, view.height);
  out.viewZ = Image<float>(view.width, view.height, std::numeric_limits<float>::infinity());
  out.normal = Image<glm::vec3>(view.width, view.height);
  out.occlusion = Image<float>(view.width, view.height);
  if (studio.sunLayer) out.sun = Image<glm::vec3>(view.width, view.height);
  tbb::parallel_for(0, view.height, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const PixelSeed seed(x, y);
      Lit sum{glm::dvec3(0.0), glm::dvec3(0.0), 0.0};
      for (int sample = 0; sample < kEdge * kEdge; ++sample) {
        const glm::dvec2 at = stratum(sample, kEdge, glm::dvec2(0.0));
        const Lit lit = shade(studio, rayThrough(x + at.x, y + at.y), sample, seed);
        sum.radiance += lit.radiance;
        sum.sun += lit.sun;
        sum.open += lit.open;
      }
      out.beauty.at(x, y) = glm::vec3(sum.radiance / static_cast<double>(kEdge * kEdge));
      if (studio.sunLayer) out.sun.at(x, y) = glm::vec3(sum.sun / static_cast<double>(kEdge * kEdge));
      out.occlusion.at(x, y) = static_cast<float>(sum.open / (kEdge * kEdge));
      const Ray centre = rayThrough(x + 0.5, y + 0.5);
      if (const auto hit = nearestHit(studio.shapes, centre)) {
        const glm::dvec3 forward = -glm::dvec3(worldFromView[2]);
        out.viewZ.at(x, y) = static_cast<float>(hit->distance * glm::dot(centre.direction, forward));
        out.normal.at(x, y) = glm::vec3(hit->normal);
      }
    }
  });
  return out;
}

Albedo plain(glm::dvec3 colour) {
  return [colour](glm::dvec3) { return colour; };
}

Albedo checker(glm::dvec3 even, glm::dvec3 odd, double edge) {
  return [=](glm::dvec3 p) {
    const glm::dvec3 cell = glm::floor(p / edge + 1e-3);
    return std::fmod(std::abs(cell.x + cell.y + cell.z), 2.0) < 0.5 ? even : odd;
  };
}

}  // namespace pellucid::samples
