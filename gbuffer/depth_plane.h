// The opaque depth of a pixel and how it changes across it: what a sample elsewhere in the pixel meets.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "gbuffer/gbuffer.h"

namespace pellucid {

constexpr double kAtEye = 1e-30;  // metres: nearer than anything, and not 0

// In a picture 1/z is linear on a plane; where the camera is orthographic, z is.
struct DepthPlane {
  double centre = 0;            // z at the pixel's centre, planar metres
  double across = 0, down = 0;  // change per pixel of what is linear, as a part of its value at the centre
  bool orthographic = false;
  // At an offset from the pixel's centre, in pixels. Where the plane has left the picture: +inf beyond its horizon,
  // kAtEye where parallel rays meet it behind the eye.
  double z(double x, double y) const {
    const double linear = 1.0 + across * x + down * y;
    if (!(linear > 0.0)) return orthographic ? kAtEye : std::numeric_limits<double>::infinity();
    return orthographic ? centre * linear : centre / linear;
  }
};

constexpr int kPlaneReach = 4;  // neighbours to either side that tell a slope
// What is linear on a plane, at the pixels of one row or column around a pixel, as a part of its value there, which is
// the one in the middle; NaN where there is none.
using PlaneValues = std::array<double, 2 * kPlaneReach + 1>;

// Its change per pixel, told by the neighbours that continue each other; nothing where none do.
//   precision  relative, of the depth
std::optional<double> slopeAlong(const PlaneValues& values, double precision);

// The planes of all pixels of a picture. Neighbours tell the slope: those that lie on one surface with the pixel, which
// are the ones that continue each other. Where none do, as on a thing one pixel wide, the file's normal tells it; where
// there is none either, the depth is that of the centre all over the pixel.
class DepthPlanes {
 public:
  //   gbuffer  must outlive this; its depth is what it was when this was made
  //   part     the pixels whose planes are told, in pixels of the data window; without it all of them
  DepthPlanes(const GBuffer& gbuffer, const Camera& camera, const Window& part);
  DepthPlanes(const GBuffer& gbuffer, const Camera& camera);

  const Window& part() const { return part_; }
  // Of a pixel of the part whose depth is finite.
  DepthPlane at(int x, int y) const;
  // The depth of all pixels at one place in each of them; all must be of the part.
  //   sample  (0..1, y down), (0.5, 0.5) the centre
  void depthAt(glm::dvec2 sample, Image<float>& viewZ) const;
  // Of the pixels of a part alone, in pixels of the data window.
  void depthAt(glm::dvec2 sample, const Window& part, Image<float>& viewZ) const;

 private:
  const GBuffer& gbuffer_;
  bool orthographic_;
  Window part_;
  Image<glm::vec2> slopes_;  // of the part: DepthPlane::across and down
};

}  // namespace pellucid
