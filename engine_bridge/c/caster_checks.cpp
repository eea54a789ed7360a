#include "engine_bridge/c/caster_checks.h"

#include <algorithm>

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {
namespace {

constexpr const char* kBegin = "pld_shadow_begin";

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

}  // namespace

pld_status checkMaps(Device& device, const pld_shadow_info& info) {
  TexelLimits limits;
  GLint edge = 0;
  device.gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &edge);
  device.gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limits.layers);
  limits.edge = std::min(edge, limits.edge);
  const CasterJudge judge{"pld_shadow_resize", device.message, sizeof(device.message)};
  const pld_status status = device.told(judgeMaps(judge, info, limits));
  return status == PLD_OK ? checkPlaces(device, info) : status;
}

pld_status checkView(Device& device, const pld_shadow_info& room, const pld_shadow_view& view, GLenum& attachment) {
  const CasterJudge judge{kBegin, device.message, sizeof(device.message)};
  if (const pld_status status = device.told(judgeView(judge, room, view)); status != PLD_OK) return status;
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
