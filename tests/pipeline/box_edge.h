// The edge that a box blurs, as motion does, and how wide that box was.
#pragma once
#include <glm/glm.hpp>

#include "gbuffer/image.h"

namespace pellucid::test {

// A pixel of an edge whose middle lies at `centre` and that a box of this width blurs; the pixel's own box lies over
// it.
inline double boxEdgePixel(int x, double centre, double width) {
  // What clamp(y, 0, 1) adds up to.
  const auto sum = [](double y) { return y < 0 ? 0.0 : y < 1 ? 0.5 * y * y : y - 0.5; };
  const double middle = x + 1.0 - centre;
  return (sum(middle + 0.5 * width) - sum(middle - 0.5 * width)) / width;
}

// The width of the box that blurs an edge along y, dark on the left: the one whose pixels are as far from 0 and 1, all
// together.
//   pixel  of x, the middle of the edge and the width: its value
template <class Pixel>
double boxWidth(const Image<glm::vec4>& picture, Pixel pixel) {
  double lit = 0, undecided = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto value = static_cast<double>(picture[i].r);
    lit += value / picture.height();
    undecided += value * (1.0 - value) / picture.height();
  }
  double low = 1e-6, high = picture.width();
  for (int step = 0; step < 60; ++step) {
    const double width = 0.5 * (low + high);
    double sum = 0;
    for (int x = 0; x < picture.width(); ++x) {
      const double value = pixel(x, picture.width() - lit, width);
      sum += value * (1.0 - value);
    }
    (sum < undecided ? low : high) = width;
  }
  return 0.5 * (low + high);
}

}  // namespace pellucid::test
