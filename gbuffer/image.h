// A plane of pixels. Row 0 is the top row of the data window, pixel (0,0) its left end; y grows downwards.
#pragma once
#include <cassert>
#include <cstddef>
#include <vector>

namespace pellucid {

template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T fill = T{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  std::size_t size() const { return pixels_.size(); }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }
  T* row(int y) { return data() + index(0, y); }
  const T* row(int y) const { return data() + index(0, y); }
  T& at(int x, int y) { return pixels_[index(x, y)]; }
  const T& at(int x, int y) const { return pixels_[index(x, y)]; }
  T& operator[](std::size_t i) { return pixels_[i]; }
  const T& operator[](std::size_t i) const { return pixels_[i]; }

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y <= height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<T> pixels_;
};

// A rectangle of pixels as EXR means it, but half open: x0 <= x < x1. May lie anywhere, negative origin included.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool operator==(const Window&) const = default;
};

}  // namespace pellucid
