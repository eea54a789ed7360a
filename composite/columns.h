// Numbers of pixels or texels for lanes that hold rows: plane after plane, and in a plane column after column, so that
// eight rows of a column lie side by side.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>

#include "gbuffer/image.h"

namespace pellucid {

class Columns {
 public:
  static constexpr int kBeyond = 8;  // rows above and below the window that may be read, too

  Columns() = default;
  // What lies in the window is not set yet.
  //   beyond  what all planes hold above and below the window
  Columns(const Window& window, int planes, float beyond)
      : window_(window),
        column_(strideOf(window.height())),
        plane_(column_ * static_cast<std::size_t>(window.width())) {
    numbers_ = std::make_unique_for_overwrite<float[]>(plane_ * static_cast<std::size_t>(planes));
    for (int k = 0; k < planes; ++k)
      for (int x = window.x0; x < window.x1; ++x) {
        std::fill_n(at(k, x, window.y0 - kBeyond), kBeyond, beyond);
        std::fill_n(at(k, x, window.y1), column_ - static_cast<std::size_t>(window.height() + kBeyond), beyond);
      }
  }
  const Window& window() const { return window_; }
  bool holds(int x, int y) const { return x >= window_.x0 && x < window_.x1 && y >= window_.y0 && y < window_.y1; }
  // The rows from y on.
  float* at(int plane, int x, int y) { return numbers_.get() + indexOf(plane, x, y); }
  const float* at(int plane, int x, int y) const { return numbers_.get() + indexOf(plane, x, y); }
  std::size_t planeStride() const { return plane_; }  // numbers from a plane to the next

 private:
  // Neighbouring columns lie no power of two apart, which few of a cache's places would hold.
  static std::size_t strideOf(int height) {
    return static_cast<std::size_t>((height + 2 * kBeyond + 31) / 32 * 32 + 8);
  }
  std::size_t indexOf(int plane, int x, int y) const {
    return static_cast<std::size_t>(plane) * plane_ + static_cast<std::size_t>(x - window_.x0) * column_ +
           static_cast<std::size_t>(y - window_.y0 + kBeyond);
  }
  Window window_;
  std::size_t column_ = 0, plane_ = 0;
  std::unique_ptr<float[]> numbers_;
};

}  // namespace pellucid
