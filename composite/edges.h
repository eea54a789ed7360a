// Pixels whose colour a renderer has filtered over an edge, taken apart into the two opaque surfaces that meet there.
// MODEL section 13
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "composite/gather.h"
#include "composite/veil.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {

// A surface as one pixel that shows it tells its plane, seen from a pixel close by.
struct PlaneNear {
  DepthPlane plane;
  glm::dvec2 from{0.0};  // where that pixel lies, in pixels
  // At an offset from the centre of the pixel that asks, in pixels, as DepthPlane::z.
  double z(double x, double y) const { return plane.z(x - from.x, y - from.y); }
};

struct EdgePixel {
  int x = 0, y = 0;              // of the data window
  double share = 0.0;            // of the nearer surface in the pixel, (0,1)
  glm::vec3 nearerPart{0.0f};    // of the pixel's colour, per channel, [0,1]; the rest is the farther surface's
  glm::vec3 whole{0.0f};         // that colour
  glm::vec3 fartherAlone{0.0f};  // of the farther surface, where pixels show nothing else
  float alpha = 1.0f;            // the pixel's, and those of its surfaces
  float nearerAlpha = 1.0f, fartherAlpha = 1.0f;
  PlaneNear nearer, farther;
  // Either surface goes behind the other where they meet, as a floor and its wall: whichever is nearer is seen there.
  bool meet = false;
  // Either ends where they meet, as two sides of a box: whichever is farther is seen there.
  bool ridge = false;
  glm::dvec2 towardsNearer{0.0};  // across the edge in the picture, unit, y down
};

// Of a flat picture, row by row. A pixel is among them where its neighbours lie on two surfaces, one behind the other,
// and its colour is a mixture of theirs: of the nearest pixels to either side that no edge touches.
//   part    the pixels that are asked about, in pixels of the data window; without it all of them
//   planes  of the part and of kEdgeSurroundings pixels around it, where the picture has them
std::vector<EdgePixel> edgePixels(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part);
std::vector<EdgePixel> edgePixels(const GBuffer& gbuffer, const DepthPlanes& planes);
constexpr int kEdgeSurroundings = 14;

// How the passes of --aa see edge pixels: each sees one of the two surfaces, which the edge's direction deals to it, so
// that transparency is composited over either side at its own depth. Passes weigh as much as the part of the surface
// that they stand for, and what they let through of the background as the part of the pixel's colour that comes from
// it: where nothing is transparent the pixel keeps its colour.
class EdgePasses {
 public:
  //   samples  where the passes sample the pixel, (0..1, y down): two at least
  EdgePasses(std::vector<EdgePixel> pixels, std::vector<glm::dvec2> samples);
  bool empty() const { return edges_.empty(); }

  // Puts the depth of the surface that the pass sees into the edge pixels.
  void depthAt(int pass, Image<float>& viewZ) const;
  // What the pass's layers look up of them.
  //   picture  of the data window
  EdgeTexels texelsOf(int pass, const Image<glm::vec4>& picture) const;
  // Puts the pass's weight in the edge pixels, 1 in the mean of all passes.
  void weightAt(int pass, Image<float>& weight) const;
  // Makes the plain mean of all passes' veils the weighted one.
  void weigh(int pass, Veil& veil) const;
  // Of that mean: what nothing touches is as if it had not been weighed.
  void finish(Veil& mean) const;

 private:
  struct Edge {
    EdgePixel pixel;
    int nearerPasses = 0;
    std::vector<bool> seesNearer;  // by pass
  };
  struct Part {
    float light;
    glm::vec3 transmission;
    float alpha;  // of the surface
  };
  Part partOf(const Edge& edge, int pass) const;

  std::vector<Edge> edges_;
  std::vector<glm::dvec2> samples_;
  bool transparentPicture_ = false;  // some edge lies before nothing: its alpha is below 1
};

}  // namespace pellucid
