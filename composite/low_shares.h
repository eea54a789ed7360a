// How much each low-resolution texel around a pixel counts in it. MODEL section 7
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "composite/low_resolution.h"
#include "shaders/low_resolution_text.h"

namespace pellucid {

class LowShares {
 public:
  // `view` must outlive this.
  LowShares(const LowView& view, glm::dvec2 sample)
      : view_(view), sample_(static_cast<float>(sample.x), static_cast<float>(sample.y)) {}

  // Calls `each` with texel and share, > 0, of the tent and, where nothing near fits, of the wide one.
  template <class Each>
  void around(int x, int y, const Each& each) const {
    const float scale = 1.0f / static_cast<float>(view_.factor), opaqueZ = view_.opaqueZ.at(x, y);
    const glm::vec2 place =
        shading::placeInTexels(glm::vec2(static_cast<float>(x), static_cast<float>(y)), sample_, scale);
    const int cx = static_cast<int>(std::floor(place.x + 0.5f)), cy = static_cast<int>(std::floor(place.y + 0.5f));
    float near = 0.0f;
    texels(cx, cy, static_cast<int>(std::ceil(shading::PLD_UPSAMPLE_TENT)), [&](int i, int j) {
      const glm::vec2 offset(static_cast<float>(i) - place.x, static_cast<float>(j) - place.y);
      const float share = shading::upsampleShare(offset, opaqueZ, view_.gbuffer.viewZ.at(i, j));
      if (!(share > 0.0f)) return;
      near += share;
      each(i, j, share);
    });
    const float wide = shading::wideWeight(near);
    if (!(wide > 0.0f)) return;
    texels(cx, cy, shading::PLD_UPSAMPLE_REACH, [&](int i, int j) {
      const glm::vec2 offset(static_cast<float>(i) - place.x, static_cast<float>(j) - place.y);
      const float share = shading::wideShare(offset, opaqueZ, view_.gbuffer.viewZ.at(i, j), wide);
      if (share > 0.0f) each(i, j, share);
    });
  }

  // Calls `each` for the texels within reach, inside of the view.
  template <class Each>
  void texels(int cx, int cy, int reach, const Each& each) const {
    const Image<float>& all = view_.gbuffer.viewZ;
    for (int j = std::max(cy - reach, 0); j <= std::min(cy + reach, all.height() - 1); ++j)
      for (int i = std::max(cx - reach, 0); i <= std::min(cx + reach, all.width() - 1); ++i) each(i, j);
  }

 private:
  const LowView& view_;
  glm::vec2 sample_;
};

}  // namespace pellucid
