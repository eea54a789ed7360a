// What is told of a face of a shadow map: rows of the table that shaders/gl/shadow_seam.glsl reads, the block of its
// casters, and how the host's form and size lie in texels. Pure functions.
#pragma once
#include <cstddef>

#include "engine_bridge/include/pellucid/pellucid.h"
#include "shaders/shadow_layout.h"

namespace pellucid::c {

// depth = scale * (planar z, or distance) + shift
struct DepthMetric {
  double scale, shift;
};
DepthMetric metricOf(const pld_shadow_view& view);

bool isFiltered(const pld_shadow_info& info);
int edgeOf(const pld_shadow_info& info);  // texels, as looked up
int channelsOf(const pld_shadow_info& info);
inline int slotOf(const pld_shadow_view& view) {
  return view.first_face + view.face;
}
// Of the maps' array, that of the face's first channel.
inline int faceLayer(const pld_shadow_info& info, const pld_shadow_view& view) {
  return slotOf(view) * channelsOf(info);
}

// The block of shaders/gl/caster_seam.glsl, PldShadowFrame.
struct CasterBlock {
  float metric[4];
  uint32_t seed[4];
};
CasterBlock casterBlock(const pld_shadow_info& info, const pld_shadow_view& view);

// The table: a row a light, then one a face. Bytes from its beginning.
constexpr std::size_t lightPlace(int light) {
  return static_cast<std::size_t>(light) * sizeof(shading::ShadowLight);
}
inline std::size_t facePlace(const pld_shadow_info& info, int slot) {
  return lightPlace(info.lights) + static_cast<std::size_t>(slot) * sizeof(shading::ShadowFace);
}
inline std::size_t tableBytes(const pld_shadow_info& info) {
  return facePlace(info, info.faces);
}
shading::ShadowLight lightRow(const pld_shadow_info& info, const pld_shadow_view& view);
//   rows  -1 where NDC's y runs against the rows, 1 where along them
shading::ShadowFace faceRow(const pld_shadow_info& info, const pld_shadow_view& view, double rows);

}  // namespace pellucid::c
