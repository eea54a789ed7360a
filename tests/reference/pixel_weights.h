// Pixel filters as their authors print them, and places of a pixel weighted by them.
#pragma once
#include <string>
#include <vector>

#include "tests/reference/traced_picture.h"

namespace pellucid::reference {

struct PixelWeights {
  std::string shape = "box";  // box, triangle, gaussian (of a third of the radius), blackman-harris
  double radius = 0.5;        // pixels to each side
  // Not normalised; x and y from the pixel's centre, pixels.
  double at(double x, double y) const;
};

// A ray's answer, and its place in the picture, pixels.
struct Sampled {
  double x = 0, y = 0;
  Met opaque;
  Vec4 background{0.0}, value{0.0};
};

// N x N places of every pixel, one in each of as many equal squares, at random within it; of the pixels around the
// picture as well, as far as the filter reaches.
class Samples {
 public:
  Samples(const Picture& picture, const PixelWeights& weights, int perEdge);
  const PixelWeights& weights() const { return weights_; }
  // Calls each(sample, weight) for all places under a pixel's filter.
  template <class Each>
  void under(int x, int y, Each&& each) const {
    for (int v = y - margin_; v <= y + margin_; ++v)
      for (int u = x - margin_; u <= x + margin_; ++u)
        for (const Sampled& sample : cell(u, v)) {
          const double weight = weights_.at(sample.x - x - 0.5, sample.y - y - 0.5);
          if (weight > 0.0) each(sample, weight);
        }
  }
  // The filtered mean of a member of all places under a pixel.
  Vec4 mean(int x, int y, Vec4 Sampled::*member) const;

 private:
  const std::vector<Sampled>& cell(int x, int y) const {
    return cells_[static_cast<std::size_t>((y + margin_) * (width_ + 2 * margin_) + x + margin_)];
  }
  PixelWeights weights_;
  int width_, margin_;
  std::vector<std::vector<Sampled>> cells_;  // by pixel
};

}  // namespace pellucid::reference
