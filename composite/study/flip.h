// FLIP, the difference that an observer sees who flips between two pictures. Andersson, Nilsson, Akenine-Möller,
// Oskarsson, Åström, Fairchild: FLIP, A Difference Evaluator for Alternating Images (HPG 2020)
#pragma once
#include <glm/glm.hpp>
#include <memory>

#include "gbuffer/image.h"

namespace pellucid {

// The paper's observer: a 0.7 m wide display of 3840 pixels, 0.7 m away.
constexpr double kFlipPixelsPerDegree = 67.020643276582255;

// Pictures are scene-linear sRGB, shown without exposure: clamped to [0,1]; what is not finite shows black.
class FlipReference {
 public:
  explicit FlipReference(const Image<glm::vec4>& reference, double pixelsPerDegree = kFlipPixelsPerDegree);
  ~FlipReference();
  // [0,1] per pixel, 0 where nobody sees a difference. The picture has the reference's size.
  Image<float> map(const Image<glm::vec4>& picture) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

double meanOf(const Image<float>& map);  // 0 of an empty one

}  // namespace pellucid
