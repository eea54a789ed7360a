#include "engine_bridge/c/caster_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/pass_permutation.h"

namespace pellucid::c {
namespace {

constexpr int kMostLights = 16, kMostCloser = 16;
constexpr float kRigid = 1e-3f;  // that a turn may be off

bool isFinite(const float* matrix) {
  return std::all_of(matrix, matrix + 16, [](float x) { return std::isfinite(x); });
}

bool isRigid(const float* m) {
  if (m[3] != 0.0f || m[7] != 0.0f || m[11] != 0.0f || m[15] != 1.0f) return false;
  const glm::mat3 turn(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
  const glm::mat3 one = glm::transpose(turn) * turn;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::fabs(one[c][r] - (c == r ? 1.0f : 0.0f)) < kRigid)) return false;
  return true;
}

pld_status checkTexels(const CasterJudge& judge, const pld_shadow_info& info, const TexelLimits& limits) {
  if (info.size < 16 || info.size > limits.edge || info.size % shading::PLD_SHADOW_DIVIDE != 0)
    return judge.fail(PLD_ERROR_SIZE, "size: found %d, expected a multiple of %d from 16 to %d", info.size,
                      shading::PLD_SHADOW_DIVIDE, limits.edge);
  if (info.faces * channelsOf(info) > limits.layers)
    return judge.fail(PLD_ERROR_SIZE, "%d faces: this device's textures have %d layers", info.faces, limits.layers);
  const int edge = edgeOf(info);
  if (static_cast<int64_t>(edge) * edge * info.faces * channelsOf(info) > INT32_MAX)
    return judge.fail(PLD_ERROR_SIZE, "%d faces of %d x %d texels: more than 2^31 - 1 together", info.faces, edge,
                      edge);
  return PLD_OK;
}

pld_status checkFaces(const CasterJudge& judge, const pld_shadow_info& room, const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  if (!local && view.kind != PLD_LIGHT_DIRECTIONAL)
    return judge.fail(PLD_ERROR_ARGUMENT, "found kind %d, which pld_light does not have", static_cast<int>(view.kind));
  if (view.light < 0 || view.light >= room.lights)
    return judge.fail(PLD_ERROR_ARGUMENT, "light: found %d, expected 0 to %d", view.light, room.lights - 1);
  if (view.faces != 1 && !(view.faces == 6 && local))
    return judge.fail(PLD_ERROR_ARGUMENT, "faces: found %d, expected 1, or 6 of a local light", view.faces);
  if (view.first_face < 0 || view.first_face > room.faces - view.faces || view.face < 0 || view.face >= view.faces)
    return judge.fail(PLD_ERROR_ARGUMENT, "face %d of %d from %d on: there is room for %d", view.face, view.faces,
                      view.first_face, room.faces);
  return PLD_OK;
}

pld_status checkMatrices(const CasterJudge& judge, const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  if (!isFinite(view.light_from_scene) || !isRigid(view.light_from_scene))
    return judge.fail(PLD_ERROR_ARGUMENT, "light_from_scene: expected a turn and a shift, by columns");
  const float* p = view.projection;
  if (!isFinite(p) || (local ? !isPerspective(p) : !isOrthographic(p)))
    return judge.fail(PLD_ERROR_ARGUMENT, "projection: expected %s, by columns",
                      local ? "perspective with w = -z" : "orthographic");
  if (p[0] == 0.0f || p[5] == 0.0f) return judge.fail(PLD_ERROR_ARGUMENT, "projection: a focal length of 0");
  const float focal = std::fabs(p[0]);
  if (view.faces == 6 && (std::fabs(p[5]) != focal || p[8] != 0.0f || p[9] != 0.0f || !(focal > 0.5f && focal < 1.0f)))
    return judge.fail(
        PLD_ERROR_ARGUMENT,
        "projection of a cube's face: found focal lengths %g, %g, expected both the same, over .5 and below 1",
        static_cast<double>(p[0]), static_cast<double>(p[5]));
  if (!std::isfinite(view.near_depth) || !std::isfinite(view.far_depth) ||
      !(local ? view.far_depth > 0.0f : view.far_depth > view.near_depth))
    return judge.fail(PLD_ERROR_ARGUMENT, "near_depth %g, far_depth %g: expected near < far, of a local light far > 0",
                      static_cast<double>(view.near_depth), static_cast<double>(view.far_depth));
  return PLD_OK;
}

}  // namespace

pld_status CasterJudge::fail(pld_status status, const char* format, ...) const {
  const int begun = std::snprintf(message, size, "%s: ", call);
  if (begun < 0 || static_cast<std::size_t>(begun) >= size) return status;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message + begun, size - static_cast<std::size_t>(begun), format, arguments);
  va_end(arguments);
  return status;
}

pld_status judgeMaps(const CasterJudge& judge, const pld_shadow_info& info, const TexelLimits& limits) {
  if (info.struct_size != sizeof(pld_shadow_info))
    return judge.fail(PLD_ERROR_VERSION, "info.struct_size: found %u, expected %zu", info.struct_size,
                      sizeof(pld_shadow_info));
  if (info.form < PLD_SHADOW_VARIANCE || info.form > PLD_SHADOW_CORRECTED)
    return judge.fail(PLD_ERROR_ARGUMENT, "found form %d, which pld_shadow_form does not have",
                      static_cast<int>(info.form));
  const struct {
    const char* name;
    int value, least, most;
  } ranges[] = {{"lights", info.lights, 1, kMostLights},
                {"faces", info.faces, 1, kMostFaces},
                {"closer_edge", info.closer_edge, 1, kMostCloser}};
  for (const auto& range : ranges)
    if (range.value < range.least || range.value > range.most)
      return judge.fail(PLD_ERROR_ARGUMENT, "%s: found %d, expected %d to %d", range.name, range.value, range.least,
                        range.most);
  return checkTexels(judge, info, limits);
}

pld_status judgeView(const CasterJudge& judge, const pld_shadow_info& room, const pld_shadow_view& view) {
  if (view.struct_size != sizeof(pld_shadow_view))
    return judge.fail(PLD_ERROR_VERSION, "view.struct_size: found %u, expected %zu", view.struct_size,
                      sizeof(pld_shadow_view));
  const pld_status status = checkFaces(judge, room, view);
  return status == PLD_OK ? checkMatrices(judge, view) : status;
}

}  // namespace pellucid::c
