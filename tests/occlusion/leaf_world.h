// Cards with binary masks, seen by Embree rays: what a renderer would leave of them, and the occlusion at any point.
// Shares nothing with composite/ but the records; rims come from the shared rimCoverage, as GL makes them.
#pragma once
#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "composite/occlusion.h"
#include "gbuffer/camera.h"
#include "samples/foliage/plants.h"

namespace pellucid::test {

struct LeafView {
  glm::dvec3 eye{0.0}, target{0.0};
  double yfov = 0.6;
  int width = 960, height = 540;  // display window
  Window data;                    // of it; empty takes all
};

// What rays leave of the world through pixel centres.
struct LeafPicture {
  Window display, data;
  Camera camera;
  Image<float> viewZ;            // nearest wholly covered point, planar metres, +inf for none
  FoliagePlanes rims;            // the nearest partly covered point in front of it
  FoliagePlanes layer;           // the cards as a renderer's layer: rims, and 1 where a card covers wholly
  Image<glm::vec2> rimGradient;  // of that point's own coverage, within its quad, y down
  Image<glm::dvec3> rimPoint, rimNormal, solidPoint, solidNormal;  // world; normals face the eye
};

class LeafWorld {
 public:
  // `masks[i]` cuts out `cards[i]`'s; a group without mask is solid.
  struct Group {
    std::vector<samples::Card> cards;
    Image<glm::vec4> mask;
  };
  explicit LeafWorld(std::vector<Group> groups, double scale = 1.0);
  ~LeafWorld();

  LeafPicture picture(const LeafView& view) const;

  // Part of each pixel of the view's window that cards cover, by edge x edge stratified rays against the finest masks.
  // [0,1]
  Image<float> coverage(const LeafView& view, int edge) const;

  // Cosine-weighted part of the hemisphere that is open within `reach` metres, by `rays` stratified rays (a square
  // number) against the finest masks, cut at 1/2. [0,1]
  double open(glm::dvec3 point, glm::dvec3 normal, double reach, int rays, std::uint32_t seed) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid::test
