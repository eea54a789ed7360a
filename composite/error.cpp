#include "composite/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pellucid {

ErrorStatistics measureError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth) {
  if (picture.width() != truth.width() || picture.height() != truth.height())
    throw std::logic_error("measureError: pictures differ in size");
  ErrorStatistics error;
  std::vector<double> largest;
  largest.reserve(picture.size());
  double sum = 0, squares = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const glm::dvec3 difference = glm::abs(glm::dvec3(picture.at(x, y)) - glm::dvec3(truth.at(x, y)));
      if (!std::isfinite(difference.r + difference.g + difference.b)) {
        ++error.nonFinite;
        continue;
      }
      sum += difference.r + difference.g + difference.b;
      squares += glm::dot(difference, difference);
      const double worst = std::max({difference.r, difference.g, difference.b});
      if (worst > error.maximum) error.maximum = worst, error.worstX = x, error.worstY = y;
      largest.push_back(worst);
    }
  error.pixels = largest.size();
  if (largest.empty()) return error;
  const double values = 3.0 * static_cast<double>(largest.size());
  error.mean = sum / values;
  error.rmse = std::sqrt(squares / values);
  const auto rank = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(largest.size() - 1));
  std::nth_element(largest.begin(), largest.begin() + rank, largest.end());
  error.p99 = largest[static_cast<std::size_t>(rank)];
  return error;
}

std::string errorLine(const ErrorStatistics& error) {
  std::string line = fmt::format("mean {:.3g}  rmse {:.3g}  p99 {:.3g}  max {:.3g} at ({}, {})", error.mean, error.rmse,
                                 error.p99, error.maximum, error.worstX, error.worstY);
  if (error.nonFinite) line += fmt::format("  not finite in {} pixels", error.nonFinite);
  return line;
}

}  // namespace pellucid
