// How a light's view becomes a face of its shadow map: where texels lie, and how far receivers move towards the light.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

#include "shaders/shadow_map.h"

namespace pellucid::shading {

// A texel X of the map lies at shrink * x + shift of the drawn texels' x: a prefiltered one on its tent's middle.
struct ShadowGrid {
  double shrink = 1.0, shift = 0.0;
};
inline ShadowGrid shadowGrid(bool filtered) {
  if (!filtered) return {};
  return {1.0 / PLD_SHADOW_DIVIDE, 0.5 - (tentMiddle(0) + 0.5) / PLD_SHADOW_DIVIDE};
}

// A face, but for where its texels are kept.
//   ndcFromSpace  from the space that the map is looked up in; its z is not needed
//   edge          texels as drawn
//   rows          -1 where NDC's y runs against the rows, 1 where along them
//   inner         part of the edge, on every side, that belongs to the faces beside this one. [0, 1/2)
inline ShadowFace shadowFaceOf(const glm::dmat4& ndcFromSpace, int edge, const ShadowGrid& grid, double rows,
                               double inner) {
  const double half = 0.5 * edge * grid.shrink;
  glm::dmat4 texels(0.0);  // and w; the last column multiplies w
  texels[0][0] = half;
  texels[1][1] = rows * half;
  texels[3] = {half + grid.shift, half + grid.shift, 0.0, 1.0};
  ShadowFace face;
  face.mapFromView = glm::mat4(texels * ndcFromSpace);
  const int kept = static_cast<int>(edge * grid.shrink);
  face.extent = ivec4(0, kept, 1, 0);
  // A hair more than the face's own, so that no direction falls between two.
  const double least = inner > 0.0 ? inner * edge * grid.shrink + grid.shift - 1e-3 * kept : 0.0;
  face.inner = glm::vec4(least, static_cast<double>(kept) + 2.0 * (inner > 0.0 ? grid.shift : 0.0) - least, 0.0, 0.0);
  return face;
}

// A slanted sheet spreads over the tent's depths, and must not shadow itself: the reach of the slab that it seems to
// be, at 45 degrees, in half texels as drawn; and that of a sheet without spread, sqrt(3) of the least deviation.
constexpr double kShadowBias = 12.0;
constexpr float kSlabReach = 1.75e-3f;

// z and w of ShadowLight::bias.
//   radial  depth is the distance to the light; else along its direction, `scale` a metre
//   focal   the smaller of the view's two
inline glm::vec2 shadowBias(bool radial, double focal, double edge, double scale) {
  const double texel = kShadowBias / (focal * edge);
  glm::vec2 bias(0.0f);
  bias[radial ? 1 : 0] = static_cast<float>(texel * (radial ? 1.0 : scale));
  bias[0] += kSlabReach;
  return bias;
}

}  // namespace pellucid::shading
