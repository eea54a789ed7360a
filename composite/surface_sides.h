// Where the opaque surfaces of a picture break off from pixel to pixel, and on which side of a pixel's own surface the
// pixels about it lie. Told by depth alone.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>

#include "gbuffer/depth_plane.h"

namespace pellucid {

constexpr int kTouchAround = 8, kSidesAround = 14;

enum class Side : std::uint8_t { own, nearer, farther };

class SurfaceSides {
 public:
  // Both must outlive this.
  //   part    the pixels whose sides are asked for, and what touches edges kTouchAround pixels around them
  //   planes  of the part and of kSidesAround pixels around it, where the picture has them
  SurfaceSides(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part);

  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  // Whether a surface breaks off between the pixel and one of the eight about it.
  bool touchesEdge(int x, int y) const { return touchesEdge_.at(x, y) != 0; }
  // On which side of pixel (x, y)'s surface another pixel lies, a few pixels away at most.
  Side sideOf(int x, int y, int u, int v) const;

 private:
  // Three steps in a row.
  struct Bends {
    double first, second, third;  // the first infinite where the picture ends
    bool told;                    // something was hit at either end of each
    // More and more steeply, as towards a ball's limb.
    bool steepens() const;
    // Bent at the third as at the second, whichever way they slope.
    bool goesOn() const;
    // The third goes on as the second.
    bool isAlike() const;
    // The second leads from another surface to that of the third.
    bool begins() const;
  };
  static bool areOne(const Bends& from, const Bends& back);
  static bool goesOnToBorder(const Bends& end, const Bends& border);
  bool hit(int x, int y) const { return std::isfinite(gbuffer_.viewZ.at(x, y)); }
  bool apart(int x, int y, int u, int v) const;
  bool onPlanes(int x, int y, int u, int v) const;
  std::optional<Bends> bendsOf(int x, int y, int dx, int dy) const;
  Window around(int reach) const;
  void markSteps();
  void markTouching();
  bool breaksBetween(int x, int y, int u, int v) const;
  bool joined(int x, int y, int u, int v) const;

  const GBuffer& gbuffer_;
  const DepthPlanes& planes_;
  Window part_;
  int width_, height_;
  Image<std::uint8_t> steps_;  // by bit, as kSteps: from the pixel to that neighbour the surface breaks off
  Image<std::uint8_t> touchesEdge_;
};

}  // namespace pellucid
