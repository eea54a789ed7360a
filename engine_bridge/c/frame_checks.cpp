#include "engine_bridge/c/frame_checks.h"

#include <cmath>

#include "engine_bridge/c/host_textures.h"
#include "shaders/weights.h"

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

enum class Range { positive, notNegative, any };

// One number of a frame.
struct Number {
  const char* name;
  pld_fixed field;
  float value;
  Range range;
  bool isRead;       // by this pass
  bool isScattered;  // of refraction and diffusion
};

bool isWithin(const Number& number) {
  if (!std::isfinite(number.value)) return false;
  return !number.isRead || number.range == Range::any || number.value > 0.0f ||
         (number.range == Range::notNegative && number.value == 0.0f);
}

// What a pass does not read may be any number, 0 of an empty struct too.
pld_status checkNumber(Device& device, const char* call, const Number& number) {
  if (isWithin(number)) return PLD_OK;
  const auto found = static_cast<double>(number.value);
  if (!number.isRead) {
    // Hosts of 0.4 and earlier were not asked for what only scattering reads.
    if (number.isScattered && !device.permutation.scatters() && !device.isHostSince(5)) return PLD_OK;
    return device.fail(PLD_ERROR_ARGUMENT,
                       "%s: frame.%s: found %g, which this pass does not read: expected a number all the same, as 0",
                       call, number.name, found);
  }
  static constexpr const char* expected[] = {"a number > 0", "a number >= 0", "a number"};
  return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.%s: found %g, expected %s", call, number.name, found,
                     expected[static_cast<int>(number.range)]);
}

pld_status checkNumbersAlone(Device& device, const char* call, const pld_frame& frame, uint32_t fields) {
  const Permutation& p = device.permutation;
  const bool distance = p.has(PLD_FEATURE_REFRACTION) && frame.refract == PLD_REFRACT_AT_DISTANCE;
  const bool diffuses = p.has(PLD_FEATURE_DIFFUSION);
  const DepthWeight* weight = depthWeightOf(static_cast<int>(p.weight));
  const bool exponent = weight && weight->parameter, reference = weight && weight->reference != WeightReference::none;
  // An orthographic lens is in pixels a metre.
  const bool lens = names(fields, PLD_FIXED_LENS) && isOrthographic(frame.projection);
  const Number numbers[] = {
      {"metres_per_unit", lens ? PLD_FIXED_LENS : PLD_FIXED_UNITS, frame.metres_per_unit, Range::positive, true, false},
      {"pre_exposure", PLD_FIXED_EXPOSURE, frame.pre_exposure, Range::positive, true, false},
      {"weight_near", PLD_FIXED_WEIGHT, frame.weight_near, Range::positive, true, false},
      {"weight_far", PLD_FIXED_WEIGHT, frame.weight_far, Range::positive, true, false},
      {"weight_exponent", PLD_FIXED_WEIGHT, frame.weight_exponent, Range::any, exponent, false},
      {"weight_reference", PLD_FIXED_WEIGHT, frame.weight_reference, Range::notNegative, reference, false},
      {"refract_distance", PLD_FIXED_REFRACTION, frame.refract_distance, Range::positive, distance, true},
      {"diffusion_k0", PLD_FIXED_DIFFUSION, frame.diffusion_k0, Range::notNegative, diffuses, true},
      {"diffusion_k1", PLD_FIXED_DIFFUSION, frame.diffusion_k1, Range::positive, diffuses, true}};
  for (const Number& number : numbers)
    if (names(fields, number.field))
      if (const pld_status status = checkNumber(device, call, number); status != PLD_OK) return status;
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
                 {PLD_FIXED_WEIGHT, frame.weight_reference, fixed.weight_reference, "weight_reference"},
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
    return device.failTexture(kBegin, "occlusion_texture", frame.occlusion_texture);
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
  const auto has = [&](pld_fixed field) { return names(fields, field); };
  if (has(PLD_FIXED_LENS) && (frame.width < 1 || frame.height < 1))
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at least 1x1", call, frame.width,
                       frame.height);
  if (has(PLD_FIXED_PROJECTION) || has(PLD_FIXED_LENS))
    if (const pld_status status = checkProjection(device, call, frame); status != PLD_OK) return status;
  if (has(PLD_FIXED_REFRACTION) && (frame.refract < PLD_REFRACT_NOTHING || frame.refract > PLD_REFRACT_THROUGH_SLAB))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: found refract %d, which pld_refract does not have", call,
                       static_cast<int>(frame.refract));
  if (const pld_status status = checkNumbersAlone(device, call, frame, fields); status != PLD_OK) return status;
  if (has(PLD_FIXED_LENS) && !(isPositive(focalOf(frame, 1).x) && isPositive(focalOf(frame, 1).y)))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length that is not finite in pixels", call);
  if (has(PLD_FIXED_WEIGHT) && !(frame.weight_far > frame.weight_near))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.weight_near %g, weight_far %g: expected near < far", call,
                       static_cast<double>(frame.weight_near), static_cast<double>(frame.weight_far));
  return PLD_OK;
}

pld_status checkFrame(Device& device, const pld_frame& frame, int width, int height, GLenum& attachment) {
  if (frame.width < 1 || frame.height < 1 || frame.width > width || frame.height > height)
    return device.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at most pld_resize()'s %dx%d", kBegin,
                       frame.width, frame.height, width, height);
  if (const pld_status status = checkNumbers(device, kBegin, frame, kEveryField); status != PLD_OK) return status;
  if (const char* field = changedField(device.permutation, frame))
    return device.fail(PLD_ERROR_ARGUMENT, "%s: frame.%s: found another than pld_fix() fixed", kBegin, field);
  if (device.trusts()) {
    attachment = device.knownAttachment;
    return checkLow(device, frame);
  }
  const pld_status status = checkTextures(device, frame, attachment);
  device.knownAttachment = attachment;
  return status;
}

}  // namespace pellucid::c
