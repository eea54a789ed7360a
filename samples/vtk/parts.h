// A scene of many translucent rectangles before a wall, its sorted truth in double, and its files.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace pellucid::vtksample {

struct Vec {
  double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator*(double s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}

// A rectangle: its corners are centre +- across +- up. View space is world space: the eye at 0 looks down -z.
struct Part {
  Vec centre, across, up;
  std::array<unsigned char, 4> colour;  // as it is shown, straight alpha
  Vec corner(int i) const;              // counterclockwise
};

class Scene {
 public:
  Scene(int parts, int width, int height);

  int width, height;
  double degrees = 30.0;  // of the field of view, up and down
  std::vector<Part> parts;
  Part wall;

  // Row 0 is the bottom row, as VTK's images have it.
  const std::array<double, 3>& truth(int x, int y) const {
    return truth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  double meanLayers() const { return layers_; }

  void writeGlb(const std::string& path) const;   // the parts, unlit, and the camera
  void writeWall(const std::string& path) const;  // R G B A Z

 private:
  std::vector<std::array<double, 3>> truth_;
  double layers_ = 0;
};

}  // namespace pellucid::vtksample
