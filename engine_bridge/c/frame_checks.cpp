#include "engine_bridge/c/frame_checks.h"

#include <cmath>

#include "engine_bridge/c/textures.h"

namespace pellucid::c {
namespace {

constexpr const char* kBegin = "pld_begin";

bool isPositive(float x) {
  return x > 0.0f && std::isfinite(x);
}

bool names(uint32_t fields, pld_fixed field) {
  return (fields & static_cast<uint32_t>(field)) != 0;
}

pld_status checkProjection(Device& device, const char* call, const pld_frame& frame) {
  for (const float x : frame.projection)
    if (!std::isfinite(x))
      return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection holds a number that is not finite", call);
  if (!isPerspective(frame.projection) && !isOrthographic(frame.projection))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "%s: frame.projection: expected perspective with w = -z, or orthographic, by columns", call);
  if (frame.projection[0] == 0.0f || frame.projection[5] == 0.0f)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length of 0", call);
  return PLD_OK;
}

pld_status checkScattering(Device& device, const char* call, const pld_frame& frame, uint32_t fields) {
  if (names(fields, PLD_FIXED_REFRACTION) &&
      (frame.refract < PLD_REFRACT_NOTHING || frame.refract > PLD_REFRACT_THROUGH_SLAB))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: found refract %d, which pld_refract does not have", call,
                       static_cast<int>(frame.refract));
  if (!device.permutation.scatters()) return PLD_OK;
  if ((names(fields, PLD_FIXED_REFRACTION) && !isPositive(frame.refract_distance)) ||
      (names(fields, PLD_FIXED_DIFFUSION) &&
       (!(frame.diffusion_k0 >= 0.0f) || !std::isfinite(frame.diffusion_k0) || !isPositive(frame.diffusion_k1))))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "%s: refract_distance %g, diffusion_k0 %g, diffusion_k1 %g: expected > 0, >= 0, > 0", call,
                       static_cast<double>(frame.refract_distance), static_cast<double>(frame.diffusion_k0),
                       static_cast<double>(frame.diffusion_k1));
  return PLD_OK;
}

// The first field that a frame has otherwise than fixed; null for none.
const char* changedField(const Permutation& permutation, const pld_frame& frame) {
  const pld_frame& fixed = permutation.fixed;
  const auto has = [&](pld_fixed field) { return names(permutation.fixedFields, field); };
  const struct {
    pld_fixed field;
    float now, before;
    const char* name;
  } numbers[] = {{PLD_FIXED_UNITS, frame.metres_per_unit, fixed.metres_per_unit, "metres_per_unit"},
                 {PLD_FIXED_EXPOSURE, frame.pre_exposure, fixed.pre_exposure, "pre_exposure"},
                 {PLD_FIXED_WEIGHT, frame.weight_near, fixed.weight_near, "weight_near"},
                 {PLD_FIXED_WEIGHT, frame.weight_far, fixed.weight_far, "weight_far"},
                 {PLD_FIXED_WEIGHT, frame.weight_exponent, fixed.weight_exponent, "weight_exponent"},
                 {PLD_FIXED_REFRACTION, frame.refract_distance, fixed.refract_distance, "refract_distance"},
                 {PLD_FIXED_DIFFUSION, frame.diffusion_k0, fixed.diffusion_k0, "diffusion_k0"},
                 {PLD_FIXED_DIFFUSION, frame.diffusion_k1, fixed.diffusion_k1, "diffusion_k1"}};
  for (const auto& number : numbers)
    if (has(number.field) && number.now != number.before) return number.name;
  if (has(PLD_FIXED_REFRACTION) && frame.refract != fixed.refract) return "refract";
  if (has(PLD_FIXED_PROJECTION) && isOrthographic(frame.projection) != isOrthographic(fixed.projection))
    return "projection";
  if (has(PLD_FIXED_LENS) && (focalOf(frame, 1).x != focalOf(fixed, 1).x || focalOf(frame, 1).y != focalOf(fixed, 1).y))
    return "projection or size";
  return nullptr;
}

pld_status checkLow(Device& device, const pld_frame& frame) {
  if (!device.permutation.low()) return PLD_OK;
  if (frame.low_factor != 2 && frame.low_factor != 4 && frame.low_factor != 8)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: low_factor: found %d, expected 2, 4 or 8", kBegin, frame.low_factor);
  if (frame.width % frame.low_factor != 0 || frame.height % frame.low_factor != 0)
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected multiples of low_factor %d", kBegin,
                       frame.width, frame.height, frame.low_factor);
  return PLD_OK;
}

pld_status checkOcclusion(Device& device, const pld_frame& frame) {
  if (!device.permutation.rims()) return PLD_OK;
  TextureFacts open;
  if (!factsOf(device.gl, frame.occlusion_texture, open))
    return device.fail(PLD_ERROR_TEXTURE, "%s: occlusion_texture %u is no 2D texture of this context", kBegin,
                       frame.occlusion_texture);
  if (!isOcclusion(open.format))
    return device.fail(PLD_ERROR_FORMAT, "%s: occlusion_texture has format 0x%x, expected numbers in red", kBegin,
                       static_cast<unsigned>(open.format));
  if (open.width < frame.width || open.height < frame.height)
    return device.fail(PLD_ERROR_SIZE, "%s: occlusion_texture is %dx%d, expected at least the frame's %dx%d", kBegin,
                       open.width, open.height, frame.width, frame.height);
  if (frame.occlusion < PLD_OCCLUSION_RELATIVE || frame.occlusion > PLD_OCCLUSION_PUBLISHED)
    return device.fail(PLD_ERROR_ARGUMENT, "%s: found occlusion %d, which pld_occlusion does not have", kBegin,
                       static_cast<int>(frame.occlusion));
  return PLD_OK;
}

pld_status checkTextures(Device& device, const pld_frame& frame, GLenum& attachment) {
  if (frame.colour_texture == frame.depth_texture)
    return device.fail(PLD_ERROR_TEXTURE, "%s: colour_texture and depth_texture are one texture, %u", kBegin,
                       frame.depth_texture);
  TextureFacts colour, depth;
  if (!factsOf(device.gl, frame.colour_texture, colour))
    return device.fail(PLD_ERROR_TEXTURE, "%s: colour_texture %u is no 2D texture of this context", kBegin,
                       frame.colour_texture);
  if (!factsOf(device.gl, frame.depth_texture, depth))
    return device.fail(PLD_ERROR_TEXTURE, "%s: depth_texture %u is no 2D texture of this context", kBegin,
                       frame.depth_texture);
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
  const auto has = [&](pld_fixed field) { return names(fields, field); };
  if (has(PLD_FIXED_LENS) && (frame.width < 1 || frame.height < 1))
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at least 1x1", call, frame.width,
                       frame.height);
  if (has(PLD_FIXED_PROJECTION) || has(PLD_FIXED_LENS))
    if (const pld_status status = checkProjection(device, call, frame); status != PLD_OK) return status;
  // An orthographic lens is in pixels a metre.
  const bool units = has(PLD_FIXED_UNITS) || (has(PLD_FIXED_LENS) && isOrthographic(frame.projection));
  if ((units && !isPositive(frame.metres_per_unit)) || (has(PLD_FIXED_EXPOSURE) && !isPositive(frame.pre_exposure)))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: metres_per_unit %g, pre_exposure %g: expected both > 0", call,
                       static_cast<double>(frame.metres_per_unit), static_cast<double>(frame.pre_exposure));
  if (has(PLD_FIXED_LENS) && !(isPositive(focalOf(frame, 1).x) && isPositive(focalOf(frame, 1).y)))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length that is not finite in pixels", call);
  if (has(PLD_FIXED_WEIGHT) && (!isPositive(frame.weight_near) || !(frame.weight_far > frame.weight_near) ||
                                !std::isfinite(frame.weight_far) || !std::isfinite(frame.weight_exponent)))
    return device.fail(PLD_ERROR_ARGUMENT,
                       "%s: weight range %g to %g, exponent %g: expected 0 < near < far and a number", call,
                       static_cast<double>(frame.weight_near), static_cast<double>(frame.weight_far),
                       static_cast<double>(frame.weight_exponent));
  return checkScattering(device, call, frame, fields);
}

pld_status checkFrame(Device& device, const pld_frame& frame, int width, int height, GLenum& attachment) {
  if (frame.width < 1 || frame.height < 1 || frame.width > width || frame.height > height)
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at most pld_resize()'s %dx%d", kBegin,
                       frame.width, frame.height, width, height);
  if (const pld_status status = checkNumbers(device, kBegin, frame, kEveryField); status != PLD_OK) return status;
  if (const char* field = changedField(device.permutation, frame))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.%s: found another than pld_fix() fixed", kBegin, field);
  return checkTextures(device, frame, attachment);
}

}  // namespace pellucid::c
