// A renderer's pixel filter: how much of what lies at each place around a pixel's centre goes into its colour.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace pellucid {

enum class FilterShape { box, triangle, gaussian, blackmanHarris };

// Separable, and nowhere negative: places drawn from it count alike.
//   box            even
//   triangle       falls linearly to 0 at the radius
//   gaussian       of a standard deviation of a third of the radius, cut off there
//   blackmanHarris Harris, On the Use of Windows for Harmonic Analysis, 1978: 4 terms, -92 dB
struct PixelFilter {
  FilterShape shape = FilterShape::box;
  double radius = 0.5;  // pixels to each side, along both axes
  bool operator==(const PixelFilter&) const = default;

  bool isPixelSquare() const { return shape == FilterShape::box && radius == 0.5; }
  // Part of the filter that lies within `distance` pixels to one side of the centre, along one axis, less that on the
  // other: from -1/2 at -radius to 1/2 at the radius.
  double integral(double distance) const;
  // Density at the centre along one axis, 1 / pixels.
  double peak() const;
  // Where in the pixel (y down; beyond 0..1 for filters wider than it) an evenly distributed place of (0,1)^2 goes, so
  // that the plain mean over such places is the filtered colour. The pixel's square changes no bit.
  glm::dvec2 placed(glm::dvec2 even) const;
};

// SHAPE[:RADIUS] as --filter takes it. Throws UsageError that names the flag, for filters with negative parts too.
PixelFilter parsePixelFilter(const std::string& text);
// The same of a header; nothing for what parsePixelFilter() refuses.
std::optional<PixelFilter> pixelFilterOf(const std::string& text);
std::string filterText(const PixelFilter& filter);  // what that reads

constexpr double kWidestFilter = 8.0;  // radius, pixels
// Of a picture or of planes that Pellucid wrote, where the filter is not the pixel's square.
constexpr const char* kFilterAttribute = "pellucid:filter";

}  // namespace pellucid
