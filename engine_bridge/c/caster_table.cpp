#include "engine_bridge/c/caster_table.h"

#include <algorithm>
#include <cmath>

namespace pellucid::c {
namespace {

glm::dmat4 matrixOf(const float* m) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<double>(m[i]);
  return matrix;
}

double focalOf(const pld_shadow_view& view) {
  return std::min(std::fabs(static_cast<double>(view.projection[0])),
                  std::fabs(static_cast<double>(view.projection[5])));
}

}  // namespace

DepthMetric metricOf(const pld_shadow_view& view) {
  const auto near = static_cast<double>(view.near_depth), far = static_cast<double>(view.far_depth);
  if (view.kind == PLD_LIGHT_LOCAL) return {1.0 / far, 0.0};
  return {2.0 / (far - near), -(far + near) / (far - near)};
}

bool isFiltered(const pld_shadow_info& info) {
  return info.form == PLD_SHADOW_VARIANCE || info.form == PLD_SHADOW_PUBLISHED;
}

int edgeOf(const pld_shadow_info& info) {
  return isFiltered(info) ? info.size / shading::PLD_SHADOW_DIVIDE : info.size;
}

int channelsOf(const pld_shadow_info& info) {
  return info.coloured ? 3 : 1;
}

CasterBlock casterBlock(const pld_shadow_info& info, const pld_shadow_view& view) {
  const bool naive = info.form == PLD_SHADOW_NAIVE || info.form == PLD_SHADOW_PUBLISHED;
  const DepthMetric metric = metricOf(view);
  return {{static_cast<float>(metric.scale), static_cast<float>(metric.shift),
           view.kind == PLD_LIGHT_LOCAL ? 1.0f : 0.0f, naive ? 1.0f : 0.0f},
          {shading::mapSeedOf(info.seed, static_cast<uint32_t>(view.light), static_cast<uint32_t>(slotOf(view)))}};
}

shading::ShadowFace faceRow(const pld_shadow_info& info, const pld_shadow_view& view, double rows) {
  const int edge = edgeOf(info), channels = channelsOf(info);
  shading::ShadowFace face = shading::shadowFaceOf(matrixOf(view.projection) * matrixOf(view.light_from_scene),
                                                   info.size, shading::shadowGrid(isFiltered(info)), rows,
                                                   view.faces == 1 ? 0.0 : 0.5 * (1.0 - focalOf(view)));
  face.extent.x = slotOf(view) * edge * edge * channels;
  face.extent.z = channels;
  return face;
}

shading::ShadowLight lightRow(const pld_shadow_info& info, const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  const glm::dmat4 lightFromScene = matrixOf(view.light_from_scene);
  const DepthMetric metric = metricOf(view);
  shading::ShadowLight light{};
  if (local) {
    light.metric = glm::vec4(glm::dvec4(glm::dvec3(glm::inverse(lightFromScene)[3]), metric.scale));
  } else {
    for (int c = 0; c < 4; ++c)
      light.metric[c] = static_cast<float>(-metric.scale * lightFromScene[c][2] + (c == 3 ? metric.shift : 0.0));
  }
  light.faces = {view.first_face, view.faces, 0, 0};
  light.lookup = {info.form == PLD_SHADOW_VARIANCE    ? shading::PLD_SHADOW_SLAB
                  : info.form == PLD_SHADOW_PUBLISHED ? shading::PLD_SHADOW_CHEBYSHEV
                                                      : shading::PLD_SHADOW_CLOSER,
                  info.form == PLD_SHADOW_VARIANCE || info.form == PLD_SHADOW_CORRECTED ? 1 : 0, info.closer_edge,
                  local ? 1 : 0};
  if (info.form != PLD_SHADOW_PUBLISHED) {
    const glm::vec2 bias = shading::shadowBias(local, focalOf(view), info.size, metric.scale);
    light.bias.z = bias.x;
    light.bias.w = bias.y;
  }
  return light;
}

}  // namespace pellucid::c
