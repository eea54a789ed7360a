#include "engine_bridge/c/caster_checks.h"

#include <algorithm>
#include <cmath>

#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {
namespace {

constexpr int kMostLights = 16, kMostCloser = 16, kMostTexels = 16384;
constexpr float kRigid = 1e-3f;  // that a turn may be off
constexpr const char* kBegin = "pld_shadow_begin";

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

pld_status checkTexels(Device& device, const pld_shadow_info& info) {
  GLint most = 0, layers = 0;
  device.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  device.gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  most = std::min(most, kMostTexels);
  if (info.size < 16 || info.size > most || info.size % shading::PLD_SHADOW_DIVIDE != 0)
    return device.fail(PLD_ERROR_SIZE, "pld_shadow_resize: size: found %d, expected a multiple of %d from 16 to %d",
                       info.size, shading::PLD_SHADOW_DIVIDE, most);
  if (info.faces * channelsOf(info) > layers)
    return device.fail(PLD_ERROR_SIZE, "pld_shadow_resize: %d faces: this device's textures have %d layers", info.faces,
                       layers);
  const int edge = edgeOf(info);
  if (static_cast<int64_t>(edge) * edge * info.faces * channelsOf(info) > INT32_MAX)
    return device.fail(PLD_ERROR_SIZE, "pld_shadow_resize: %d faces of %d x %d texels: more than 2^31 - 1 together",
                       info.faces, edge, edge);
  return PLD_OK;
}

pld_status checkPlaces(Device& device, const pld_shadow_info& info) {
  GLint bindings = 0, units = 0;
  device.gl.GetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &bindings);
  device.gl.GetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  if (info.uniform_binding >= static_cast<uint32_t>(bindings) || info.texture_unit >= static_cast<uint32_t>(units))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "pld_shadow_resize: uniform_binding %u, texture_unit %u: the device has %d bindings, %d units",
                       info.uniform_binding, info.texture_unit, bindings, units);
  const pld_create_info& seam = device.info;
  const auto seamUnits = static_cast<uint32_t>(device.permutation.seamUnits());
  if (info.uniform_binding == seam.uniform_binding || info.texture_unit - seam.texture_unit < seamUnits)
    return device.fail(
        PLD_ERROR_ARGUMENT,
        "pld_shadow_resize: uniform_binding %u, texture_unit %u: expected others than the seam's, %u and %u to %u",
        info.uniform_binding, info.texture_unit, seam.uniform_binding, seam.texture_unit,
        seam.texture_unit + seamUnits - 1);
  return PLD_OK;
}

pld_status checkFaces(Device& device, const pld_shadow_info& room, const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  if (!local && view.kind != PLD_LIGHT_DIRECTIONAL)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: found kind %d, which pld_light does not have", kBegin,
                       static_cast<int>(view.kind));
  if (view.light < 0 || view.light >= room.lights)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: light: found %d, expected 0 to %d", kBegin, view.light,
                       room.lights - 1);
  if (view.faces != 1 && !(view.faces == 6 && local))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: faces: found %d, expected 1, or 6 of a local light", kBegin,
                       view.faces);
  if (view.first_face < 0 || view.first_face > room.faces - view.faces || view.face < 0 || view.face >= view.faces)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: face %d of %d from %d on: there is room for %d", kBegin, view.face,
                       view.faces, view.first_face, room.faces);
  return PLD_OK;
}

pld_status checkMatrices(Device& device, const pld_shadow_view& view) {
  const bool local = view.kind == PLD_LIGHT_LOCAL;
  if (!isFinite(view.light_from_scene) || !isRigid(view.light_from_scene))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: light_from_scene: expected a turn and a shift, by columns", kBegin);
  const float* p = view.projection;
  if (!isFinite(p) || (local ? !isPerspective(p) : !isOrthographic(p)))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: projection: expected %s, by columns", kBegin,
                       local ? "perspective with w = -z" : "orthographic");
  if (p[0] == 0.0f || p[5] == 0.0f)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: projection: a focal length of 0", kBegin);
  const float focal = std::fabs(p[0]);
  if (view.faces == 6 && (std::fabs(p[5]) != focal || p[8] != 0.0f || p[9] != 0.0f || !(focal > 0.5f && focal < 1.0f)))
    return device.fail(
        PLD_ERROR_ARGUMENT,
        "%s: projection of a cube's face: found focal lengths %g, %g, expected both the same, over .5 and below 1",
        kBegin, static_cast<double>(p[0]), static_cast<double>(p[5]));
  if (!std::isfinite(view.near_depth) || !std::isfinite(view.far_depth) ||
      !(local ? view.far_depth > 0.0f : view.far_depth > view.near_depth))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "%s: near_depth %g, far_depth %g: expected near < far, of a local light far > 0", kBegin,
                       static_cast<double>(view.near_depth), static_cast<double>(view.far_depth));
  return PLD_OK;
}

}  // namespace

pld_status checkMaps(Device& device, const pld_shadow_info& info) {
  if (info.struct_size != sizeof(pld_shadow_info))
    return device.fail(PLD_ERROR_VERSION, "pld_shadow_resize: info.struct_size: found %u, expected %zu",
                       info.struct_size, sizeof(pld_shadow_info));
  if (info.form < PLD_SHADOW_VARIANCE || info.form > PLD_SHADOW_CORRECTED)
    return device.fail(PLD_ERROR_ARGUMENT, "pld_shadow_resize: found form %d, which pld_shadow_form does not have",
                       static_cast<int>(info.form));
  const struct {
    const char* name;
    int value, least, most;
  } ranges[] = {{"lights", info.lights, 1, kMostLights},
                {"faces", info.faces, 1, kMostFaces},
                {"closer_edge", info.closer_edge, 1, kMostCloser}};
  for (const auto& range : ranges)
    if (range.value < range.least || range.value > range.most)
      return device.fail(PLD_ERROR_ARGUMENT, "pld_shadow_resize: %s: found %d, expected %d to %d", range.name,
                         range.value, range.least, range.most);
  const pld_status status = checkTexels(device, info);
  return status == PLD_OK ? checkPlaces(device, info) : status;
}

pld_status checkView(Device& device, const pld_shadow_info& room, const pld_shadow_view& view, GLenum& attachment) {
  if (view.struct_size != sizeof(pld_shadow_view))
    return device.fail(PLD_ERROR_VERSION, "%s: view.struct_size: found %u, expected %zu", kBegin, view.struct_size,
                       sizeof(pld_shadow_view));
  if (const pld_status status = checkFaces(device, room, view); status != PLD_OK) return status;
  if (const pld_status status = checkMatrices(device, view); status != PLD_OK) return status;
  attachment = 0;
  if (view.depth_texture == 0) return PLD_OK;
  TextureFacts depth;
  if (!factsOf(device.gl, view.depth_texture, depth))
    return device.failTexture(kBegin, "depth_texture", view.depth_texture);
  attachment = depthAttachment(depth.format);
  if (attachment == 0)
    return device.fail(PLD_ERROR_FORMAT, "%s: depth_texture has format 0x%x, expected a depth format", kBegin,
                       static_cast<unsigned>(depth.format));
  if (depth.width < room.size || depth.height < room.size)
    return device.fail(PLD_ERROR_SIZE, "%s: depth_texture is %dx%d, expected at least %dx%d", kBegin, depth.width,
                       depth.height, room.size, room.size);
  return PLD_OK;
}

}  // namespace pellucid::c
