// The pixel nearest to the eye in every block of 2, 4, 8... pixels: what stands out is found without looking at each.
#pragma once
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

class NearestPyramid {
 public:
  //   viewZ  planar metres, > 0; beyond kFar nothing was hit. Must outlive this.
  explicit NearestPyramid(const Image<float>& viewZ);

  static constexpr float kFar = 1e30f;
  bool hit(int x, int y) const;
  int levels() const { return static_cast<int>(coarse_.size()); }
  // Index of the nearest pixel in the block of 2^level that holds (x, y); -1 outside, or where nothing was hit.
  int at(int x, int y, int level) const;

 private:
  const Image<float>& viewZ_;
  std::vector<Image<int>> coarse_;  // level 1 and up
};

}  // namespace pellucid
