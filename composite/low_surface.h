// Where a pixel's opaque surface lies at the low-resolution texels around it, so that a thin layer which lies on it, or
// just behind it, is told there and not where the pixel is. MODEL section 7
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "gbuffer/depth_plane.h"
#include "shaders/low_resolution_text.h"

namespace pellucid {

struct LowView;

class LowSurface {
 public:
  // All must outlive this. Where LowView::planes is null the depths around a pixel tell its surface, as in the C
  // library.
  //   sample  where in pixels and texels both were sampled, (0..1, y down)
  LowSurface(const LowView& view, const Image<shading::LowTexel>& texels, glm::dvec2 sample);

  // What texels are asked about, of one pixel.
  struct Pixel {
    int x, y;       // of the data window
    float opaqueZ;  // planar metres, +inf for sky
    DepthPlane plane;
    bool hasPlane;                // the pixel shows the surface that its plane tells
    shading::SurfaceNear around;  // without planes
  };
  Pixel pixel(int x, int y) const;

  // How much of a texel's layers stands before the pixel's surface, [0,1]. A thin layer is followed along its plane to
  // the pixel or, where its neighbours do not tell that, compared with the surface at the texel's sample; what fills a
  // texel in depth, as smoke does, is compared with the pixel's own depth.
  float standingBefore(const Pixel& pixel, int i, int j) const { return standingBefore(pixel, i, j, texels_.at(i, j)); }
  // Of some layers of that texel: z and nearestZ are read.
  float standingBefore(const Pixel& pixel, int i, int j, const shading::LowTexel& texel) const;

 private:
  struct Own {
    double z = 0.0;  // of the surface at the texel's sample; 0 where none is known
    glm::dvec2 slope{0.0};
    std::optional<DepthPlane> layer;  // of the texel's only layer, per texel
  };
  glm::dvec2 placeOf(int i, int j) const;  // of a texel's sample, pixels
  Own ownOf(int i, int j) const;
  std::optional<DepthPlane> layerOf(int i, int j) const;
  std::optional<double> layerSlope(int i, int j, int axis) const;
  shading::SurfaceNear aroundOf(int x, int y) const;
  float beforeAround(const Pixel& pixel, const shading::LowTexel& texel, int i, int j) const;
  float metAt(const Pixel& pixel, int i, int j) const;
  std::optional<shading::LowTexel> followed(const Pixel& pixel, int i, int j) const;
  float contact(const DepthPlane& plane, double perTexel) const;

  const LowView& view_;
  const Image<shading::LowTexel>& texels_;
  glm::dvec2 sample_;
  float contact_;
  Image<Own> own_;
};

}  // namespace pellucid
