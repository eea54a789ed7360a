// Shadows on the picture that move while the shutter is open: what they change behind each pass's veil.
#pragma once
#include <glm/glm.hpp>

#include "composite/veil.h"

namespace pellucid {

// Passes are composed over one picture, that of the frame. Where a pass's light leaves another colour there, the
// difference as the pass's veil lets it through is added to the mean of the veils.
class MovingLight {
 public:
  // Of every pass in turn, whose veil has the picture's size.
  //   now   the picture's colours as they are lit in the pass; null: as in the frame
  //   then  as they are lit in the frame
  void add(const Veil& veil, const Image<glm::vec4>* now, const Image<glm::vec4>& then);
  void finish(Veil& mean) const;

 private:
  Image<glm::dvec3> changed_;  // empty until there is something
  Image<std::uint8_t> touched_;
  int passes_ = 0;
};

}  // namespace pellucid
