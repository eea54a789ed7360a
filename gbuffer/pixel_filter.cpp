#include "gbuffer/pixel_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

struct Row {
  const char* name;
  FilterShape shape;
  double radius;  // where none is given
};
constexpr Row kRows[] = {{"box", FilterShape::box, 0.5},
                         {"triangle", FilterShape::triangle, 1.0},
                         {"gaussian", FilterShape::gaussian, 1.5},
                         {"blackman-harris", FilterShape::blackmanHarris, 1.5}};
constexpr const char* kNegative[] = {
    "mitchell", "mitchell-netravali", "catmull-rom", "catrom", "lanczos", "sinc", "cubic", "sharpen"};
constexpr const char* kExpected = "box, triangle, gaussian or blackman-harris, each with :RADIUS in pixels or without";

constexpr double kSigmas = 3.0;  // standard deviations of the gaussian in its radius
constexpr double kTerms[4] = {0.35875, 0.48829, 0.14128, 0.01168};

double blackmanHarrisIntegral(double t) {  // t from -1 to 1
  const double angle = std::numbers::pi * t;
  return 0.5 * t + (kTerms[1] * std::sin(angle) + kTerms[2] * std::sin(2.0 * angle) / 2.0 +
                    kTerms[3] * std::sin(3.0 * angle) / 3.0) /
                       (2.0 * std::numbers::pi * kTerms[0]);
}

double gaussianIntegral(double t) {
  const double scale = kSigmas / std::numbers::sqrt2;
  return 0.5 * std::erf(scale * t) / std::erf(scale);
}

// Where the integral reaches `part`, which lies between -1/2 and 1/2, by halving: it only grows.
double placeOf(const PixelFilter& filter, double part) {
  double low = -filter.radius, high = filter.radius;
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (low + high);
    (filter.integral(middle) < part ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double along(const PixelFilter& filter, double even) {
  const double part = even - 0.5;
  switch (filter.shape) {
    case FilterShape::box:
      return 0.5 + 2.0 * filter.radius * part;
    case FilterShape::triangle:
      return 0.5 + std::copysign(filter.radius * (1.0 - std::sqrt(1.0 - 2.0 * std::abs(part))), part);
    case FilterShape::gaussian:
    case FilterShape::blackmanHarris:
      break;
  }
  return 0.5 + placeOf(filter, part);
}

}  // namespace

double PixelFilter::integral(double distance) const {
  const double t = std::clamp(distance / radius, -1.0, 1.0);
  switch (shape) {
    case FilterShape::box:
      return 0.5 * t;
    case FilterShape::triangle:
      return t - 0.5 * t * std::abs(t);
    case FilterShape::gaussian:
      return gaussianIntegral(t);
    case FilterShape::blackmanHarris:
      break;
  }
  return blackmanHarrisIntegral(t);
}

double PixelFilter::peak() const {
  switch (shape) {
    case FilterShape::box:
      return 0.5 / radius;
    case FilterShape::triangle:
      return 1.0 / radius;
    case FilterShape::gaussian:
      return kSigmas / (radius * std::sqrt(2.0 * std::numbers::pi) * std::erf(kSigmas / std::numbers::sqrt2));
    case FilterShape::blackmanHarris:
      break;
  }
  return (kTerms[0] + kTerms[1] + kTerms[2] + kTerms[3]) / (2.0 * kTerms[0] * radius);
}

glm::dvec2 PixelFilter::placed(glm::dvec2 even) const {
  return isPixelSquare() ? even : glm::dvec2(along(*this, even.x), along(*this, even.y));
}

PixelFilter parsePixelFilter(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  if (std::find(std::begin(kNegative), std::end(kNegative), name) != std::end(kNegative))
    throw UsageError(
        fmt::format("--filter: found '{}', expected {}: a filter with negative parts is no density to draw places from",
                    text, kExpected));
  const auto* row = std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& one) { return name == one.name; });
  if (row == std::end(kRows)) throw UsageError(fmt::format("--filter: found '{}', expected {}", text, kExpected));
  PixelFilter filter{row->shape, row->radius};
  if (colon == std::string::npos) return filter;
  const char *first = text.data() + colon + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, filter.radius);
  if (error != std::errc() || end != last || !(filter.radius > 0.0) || filter.radius > kWidestFilter)
    throw UsageError(fmt::format("--filter: found radius '{}', expected a number above 0 and up to {:g} pixels",
                                 text.substr(colon + 1), kWidestFilter));
  return filter;
}

std::optional<PixelFilter> pixelFilterOf(const std::string& text) {
  try {
    return parsePixelFilter(text);
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

std::string filterText(const PixelFilter& filter) {
  const auto* row =
      std::find_if(std::begin(kRows), std::end(kRows), [&](const Row& one) { return filter.shape == one.shape; });
  return fmt::format("{}:{}", row->name, filter.radius);
}

}  // namespace pellucid
