// What lookups are told of a face of a shadow map: rows of the table that shaders/gl/shadow_seam.glsl reads, and how
// the host's form and size lie in texels. Pure functions.
#pragma once
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

shading::ShadowLight lightRow(const pld_shadow_info& info, const pld_shadow_view& view);
//   rows  -1 where NDC's y runs against the rows, 1 where along them
shading::ShadowFace faceRow(const pld_shadow_info& info, const pld_shadow_view& view, double rows);

}  // namespace pellucid::c
