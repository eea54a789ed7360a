// A plane of pixels. Row 0 is the top row of the data window, pixel (0,0) its left end; y grows downwards.
#pragma once
#include <cassert>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace pellucid {

// It has its own pixels, or shows those of another who lends them. A copy of either has its own.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T fill = T{}) : Image(std::vector<T>(count(width, height), fill), width, height) {}
  // Shows pixels that lie row by row in the memory of another. Nobody writes them as long as it does.
  //   owner  is kept as long as the image shows them; null: whoever has the image knows that they outlive it
  static Image borrowed(int width, int height, const T* pixels, std::shared_ptr<const void> owner) {
    Image image;
    image.width_ = width;
    image.height_ = height;
    image.pixels_ = const_cast<T*>(pixels);
    image.owner_ = std::move(owner);
    return image;
  }
  // Another image that shows the pixels of this one.
  Image shown(std::shared_ptr<const void> owner) const { return borrowed(width_, height_, pixels_, std::move(owner)); }
  Image(const Image& other) : Image(std::vector<T>(other.data(), other.data() + other.size()), other) {}
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(const Image& other) {
    if (this == &other) return *this;
    own_.assign(other.data(), other.data() + other.size());  // into the memory that it had, where that is enough
    width_ = other.width_;
    height_ = other.height_;
    pixels_ = own_.data();
    owner_.reset();
    return *this;
  }
  Image& operator=(Image&& other) noexcept {
    Image taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~Image() = default;

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return size() == 0; }
  std::size_t size() const { return count(width_, height_); }
  T* data() { return pixels_; }
  const T* data() const { return pixels_; }
  T* row(int y) { return data() + index(0, y); }
  const T* row(int y) const { return data() + index(0, y); }
  T& at(int x, int y) { return pixels_[index(x, y)]; }
  const T& at(int x, int y) const { return pixels_[index(x, y)]; }
  T& operator[](std::size_t i) { return pixels_[i]; }
  const T& operator[](std::size_t i) const { return pixels_[i]; }

 private:
  Image(std::vector<T> own, int width, int height)
      : width_(width), height_(height), own_(std::move(own)), pixels_(own_.data()) {}
  Image(std::vector<T> own, const Image& size) : Image(std::move(own), size.width_, size.height_) {}
  void swap(Image& other) noexcept {
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    own_.swap(other.own_);  // pixels stay where they are
    std::swap(pixels_, other.pixels_);
    owner_.swap(other.owner_);
  }
  static std::size_t count(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  std::size_t index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y <= height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<T> own_;  // empty where the pixels are another's
  T* pixels_ = nullptr;
  std::shared_ptr<const void> owner_;  // of the pixels that are another's
};

// A rectangle of pixels as EXR means it, but half open: x0 <= x < x1. May lie anywhere, negative origin included.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool operator==(const Window&) const = default;
};

}  // namespace pellucid
