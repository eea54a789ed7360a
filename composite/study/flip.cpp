#include "composite/study/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace pellucid {
namespace {

using glm::dvec3;
using Plane = Image<double>;
using Kernel = std::vector<double>;  // odd length, centred
constexpr double kPi = std::numbers::pi;

// Exponents and thresholds of sections 4.1.3, 4.2 and 4.3.
constexpr double kColourPower = 0.7, kLowShare = 0.4, kLowTarget = 0.95, kFeaturePower = 0.5;
constexpr double kFeatureWidth = 0.082;  // degrees

// Contrast sensitivity of section 4.1.1 as sums of two Gaussians, table 1: of luminance, red-green and blue-yellow.
struct Sensitivity {
  double a[2], b[2];
};
constexpr Sensitivity kSensitivity[3] = {
    {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};
constexpr double kWidest = 0.04;

// Linear sRGB, D65.
const glm::dmat3 kXyzFromRgb(dvec3(10135552, 5226144, 475104) / 24577794.0,
                             dvec3(8788810.0 / 24577794, 17577620.0 / 24577794, 8788810.0 / 73733382),
                             dvec3(4435075.0 / 24577794, 1774030.0 / 24577794, 70074185.0 / 73733382));

dvec3 whitePoint() {
  return kXyzFromRgb * dvec3(1.0);
}

// A linearised CIELAB: opponents that may be filtered.
dvec3 opponentsOf(const dvec3& rgb) {
  const dvec3 xyz = kXyzFromRgb * rgb / whitePoint();
  return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

dvec3 rgbOf(const dvec3& opponents) {
  const double y = (opponents.x + 16.0) / 116.0;
  const dvec3 xyz = dvec3(y + opponents.y / 500.0, y, y - opponents.z / 200.0) * whitePoint();
  return glm::inverse(kXyzFromRgb) * xyz;
}

double labCurve(double t) {
  constexpr double kKnee = 6.0 / 29.0;
  return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
}

// CIELAB whose chroma grows with luminance (Hunt).
dvec3 huntLabOf(const dvec3& rgb) {
  const dvec3 xyz = kXyzFromRgb * rgb / whitePoint();
  const double fy = labCurve(xyz.y), L = 116.0 * fy - 16.0;
  return {L, 0.01 * L * 500.0 * (labCurve(xyz.x) - fy), 0.01 * L * 200.0 * (fy - labCurve(xyz.z))};
}

double hyab(const dvec3& a, const dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// Compresses large differences: those up to a share of the largest take most of the range.
double redistributed(double difference) {
  static const double largest = std::pow(hyab(huntLabOf({0, 1, 0}), huntLabOf({0, 0, 1})), kColourPower);
  const double powered = std::pow(difference, kColourPower), knee = kLowShare * largest;
  return powered < knee ? kLowTarget / knee * powered
                        : kLowTarget + (powered - knee) / (largest - knee) * (1.0 - kLowTarget);
}

Kernel kernelOf(int radius, auto&& value) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(value(static_cast<double>(i)));
  return kernel;
}

// Positive weights sum to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double k : kernel) (k > 0 ? positive : negative) += k;
  for (double& k : kernel) k /= k > 0 ? positive : negative < 0 ? -negative : 1.0;
  return kernel;
}

// Rows first; pixels beyond the border repeat it.
Plane filtered(const Plane& plane, const Kernel& across, const Kernel& down) {
  const int width = plane.width(), height = plane.height();
  Plane rows(width, height), result(width, height);
  const auto pass = [&](const Plane& from, Plane& to, const Kernel& kernel, bool vertical) {
    const int radius = static_cast<int>(kernel.size() / 2);
    tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& range) {
      for (int y = range.begin(); y != range.end(); ++y)
        for (int x = 0; x < width; ++x) {
          double sum = 0;
          for (int i = -radius; i <= radius; ++i)
            sum +=
                kernel[static_cast<std::size_t>(i + radius)] *
                (vertical ? from.at(x, std::clamp(y + i, 0, height - 1)) : from.at(std::clamp(x + i, 0, width - 1), y));
          to.at(x, y) = sum;
        }
    });
  };
  pass(plane, rows, across, false);
  pass(rows, result, down, true);
  return result;
}

std::array<Plane, 3> opponentPlanes(const Image<glm::vec4>& picture) {
  std::array<Plane, 3> planes;
  for (Plane& plane : planes) plane = Plane(picture.width(), picture.height());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    dvec3 rgb{glm::vec3(picture[i])};
    for (int c = 0; c < 3; ++c) rgb[c] = std::isfinite(rgb[c]) ? std::clamp(rgb[c], 0.0, 1.0) : 0.0;
    const dvec3 opponents = opponentsOf(rgb);
    for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)][i] = opponents[c];
  }
  return planes;
}

// What the eye resolves of each opponent.
Plane sensed(const Plane& plane, const Sensitivity& sensitivity, double pixelsPerDegree) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixelsPerDegree));
  Plane sum(plane.width(), plane.height(), 0.0);
  double total = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    if (sensitivity.a[k] <= 0) continue;
    const double height = sensitivity.a[k] * std::sqrt(kPi / sensitivity.b[k]);
    const Kernel gaussian = kernelOf(radius, [&](double i) {
      const double degrees = i / pixelsPerDegree;
      return std::exp(-kPi * kPi * degrees * degrees / sensitivity.b[k]);
    });
    double across = 0;
    for (const double g : gaussian) across += g;
    total += height * across * across;
    const Plane part = filtered(plane, gaussian, gaussian);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += height * part[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= total;
  return sum;
}

// Magnitudes of first (edges) and second (points) derivatives of luminance, section 4.2.
std::array<Plane, 2> features(Plane luminance, double pixelsPerDegree) {
  for (std::size_t i = 0; i < luminance.size(); ++i) luminance[i] = (luminance[i] + 16.0) / 116.0;
  const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  const auto gaussian = [&](double i) { return std::exp(-i * i / (2.0 * deviation * deviation)); };
  const Kernel smooth = balanced(kernelOf(radius, gaussian));
  const Kernel slope = balanced(kernelOf(radius, [&](double i) { return -i * gaussian(i); }));
  const Kernel bend =
      balanced(kernelOf(radius, [&](double i) { return (i * i / (deviation * deviation) - 1.0) * gaussian(i); }));
  std::array<Plane, 2> result;
  for (std::size_t k = 0; k < 2; ++k) {
    const Kernel& kernel = k == 0 ? slope : bend;
    const Plane across = filtered(luminance, kernel, smooth), down = filtered(luminance, smooth, kernel);
    result[k] = Plane(luminance.width(), luminance.height());
    for (std::size_t i = 0; i < across.size(); ++i) result[k][i] = std::hypot(across[i], down[i]);
  }
  return result;
}

struct Seen {
  std::array<Plane, 3> opponents;
  std::array<Plane, 2> features;
};

Seen seen(const Image<glm::vec4>& picture, double pixelsPerDegree) {
  const std::array<Plane, 3> planes = opponentPlanes(picture);
  Seen result;
  for (std::size_t c = 0; c < 3; ++c) result.opponents[c] = sensed(planes[c], kSensitivity[c], pixelsPerDegree);
  result.features = features(planes[0], pixelsPerDegree);
  return result;
}

}  // namespace

struct FlipReference::Impl {
  Seen seen;
  double pixelsPerDegree;
};

FlipReference::FlipReference(const Image<glm::vec4>& reference, double pixelsPerDegree)
    : impl_(new Impl{seen(reference, pixelsPerDegree), pixelsPerDegree}) {}

FlipReference::~FlipReference() = default;

Image<float> FlipReference::map(const Image<glm::vec4>& picture) const {
  const Seen& a = impl_->seen;
  if (picture.width() != a.features[0].width() || picture.height() != a.features[0].height())
    throw std::logic_error("FlipReference: pictures differ in size");
  const Seen b = seen(picture, impl_->pixelsPerDegree);
  Image<float> map(picture.width(), picture.height());
  const auto labAt = [](const Seen& s, std::size_t i) {
    const dvec3 rgb = rgbOf({s.opponents[0][i], s.opponents[1][i], s.opponents[2][i]});
    return huntLabOf(glm::clamp(rgb, dvec3(0.0), dvec3(1.0)));
  };
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double colour = redistributed(hyab(labAt(a, i), labAt(b, i)));
    const double edges = std::abs(a.features[0][i] - b.features[0][i]);
    const double points = std::abs(a.features[1][i] - b.features[1][i]);
    const double feature = std::pow(std::max(edges, points) / std::numbers::sqrt2, kFeaturePower);
    map[i] = static_cast<float>(std::pow(colour, 1.0 - feature));
  }
  return map;
}

double meanOf(const Image<float>& map) {
  double sum = 0;
  for (std::size_t i = 0; i < map.size(); ++i) sum += static_cast<double>(map[i]);
  return map.size() > 0 ? sum / static_cast<double>(map.size()) : 0.0;
}

}  // namespace pellucid
