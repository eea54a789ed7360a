#include "engine_bridge/c/frame_checks.h"

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {
namespace {

constexpr const char* kBegin = "pld_begin";

FrameJudge judgeOf(Device& device) {
  return {device.permutation, device.info.version, device.message, sizeof(device.message)};
}

pld_status checkLow(Device& device, const pld_frame& frame) {
  return device.told(judgeLow(judgeOf(device), kBegin, frame));
}

pld_status checkOcclusion(Device& device, const pld_frame& frame) {
  if (!device.permutation.rims()) return PLD_OK;
  TextureFacts open;
  if (!factsOf(device.gl, frame.occlusion_texture, open))
    return device.failTexture(kBegin, "occlusion_texture", frame.occlusion_texture);
  if (!isOcclusion(open.format))
    return device.fail(PLD_ERROR_FORMAT, "%s: occlusion_texture has format 0x%x, expected numbers in red", kBegin,
                       static_cast<unsigned>(open.format));
  if (open.width < frame.width || open.height < frame.height)
    return device.fail(PLD_ERROR_SIZE, "%s: occlusion_texture is %dx%d, expected at least the frame's %dx%d", kBegin,
                       open.width, open.height, frame.width, frame.height);
  return device.told(judgeOcclusion(judgeOf(device), kBegin, frame));
}

pld_status checkTextures(Device& device, const pld_frame& frame, GLenum& attachment) {
  if (frame.colour_texture == frame.depth_texture)
    return device.fail(PLD_ERROR_TEXTURE, "%s: colour_texture and depth_texture are one texture, %u", kBegin,
                       frame.depth_texture);
  TextureFacts colour, depth;
  if (!factsOf(device.gl, frame.colour_texture, colour))
    return device.failTexture(kBegin, "colour_texture", frame.colour_texture);
  if (!factsOf(device.gl, frame.depth_texture, depth))
    return device.failTexture(kBegin, "depth_texture", frame.depth_texture);
  if (!isColour(colour.format))
    return device.fail(PLD_ERROR_FORMAT, "%s: colour_texture has format 0x%x, expected RGB or RGBA", kBegin,
                       static_cast<unsigned>(colour.format));
  const bool linear = device.permutation.depth == PLD_DEPTH_LINEAR;
  attachment = linear ? 0 : depthAttachment(depth.format);
  if (linear ? !isLinearDepth(depth.format) : attachment == 0)
    return device.fail(PLD_ERROR_FORMAT, "%s: depth_texture has format 0x%x, expected %s", kBegin,
                       static_cast<unsigned>(depth.format), linear ? "a float colour format" : "a depth format");
  if (const pld_status status = checkLow(device, frame); status != PLD_OK) return status;
  if (const pld_status status = checkOcclusion(device, frame); status != PLD_OK) return status;
  if (colour.width < frame.width || colour.height < frame.height || depth.width < frame.width ||
      depth.height < frame.height)
    return device.fail(PLD_ERROR_SIZE,
                       "%s: colour_texture %dx%d, depth_texture %dx%d: expected at least the frame's %dx%d", kBegin,
                       colour.width, colour.height, depth.width, depth.height, frame.width, frame.height);
  return PLD_OK;
}

}  // namespace

pld_status checkNumbers(Device& device, const char* call, const pld_frame& frame, uint32_t fields) {
  return device.told(judgeNumbers(judgeOf(device), call, frame, fields));
}

pld_status checkFrame(Device& device, const pld_frame& frame, int width, int height, GLenum& attachment) {
  if (frame.width < 1 || frame.height < 1 || frame.width > width || frame.height > height)
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at most pld_resize()'s %dx%d", kBegin,
                       frame.width, frame.height, width, height);
  if (const pld_status status = checkNumbers(device, kBegin, frame, kEveryField); status != PLD_OK) return status;
  if (const pld_status status = device.told(judgeOpacity(judgeOf(device), kBegin, frame)); status != PLD_OK)
    return status;
  if (const pld_status status = device.told(judgeFixed(judgeOf(device), kBegin, "pld_fix()", frame)); status != PLD_OK)
    return status;
  if (device.trusts()) {
    attachment = device.knownAttachment;
    return checkLow(device, frame);
  }
  const pld_status status = checkTextures(device, frame, attachment);
  device.knownAttachment = attachment;
  return status;
}

}  // namespace pellucid::c
