#include "engine_bridge/c/frame_numbers.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "shaders/weights.h"

namespace pellucid::c {
namespace {

bool isPositive(float x) {
  return x > 0.0f && std::isfinite(x);
}

bool names(uint32_t fields, pld_fixed field) {
  return (fields & static_cast<uint32_t>(field)) != 0;
}

// How device depth changes with the distance from the eye, by its sign.
float depthGrowth(const float (&projection)[16]) {
  return isPerspective(projection) ? -projection[14] : -projection[10];
}

// A projection that contradicts the convention leaves no layer: each fails its depth test.
pld_status checkConvention(const FrameJudge& judge, const char* call, const pld_frame& frame) {
  const pld_depth depth = judge.permutation.depth;
  const float growth = depthGrowth(frame.projection);
  if (!judge.isHostSince(15) || depth == PLD_DEPTH_LINEAR) return PLD_OK;
  if (depth == PLD_DEPTH_DEVICE && growth < 0.0f)
    return judge.fail(PLD_ERROR_ARGUMENT,
                      "%s: frame.projection: found depth that falls with distance, expected one that grows: info.depth "
                      "is PLD_DEPTH_DEVICE",
                      call);
  if (depth == PLD_DEPTH_REVERSED && growth > 0.0f)
    return judge.fail(PLD_ERROR_ARGUMENT,
                      "%s: frame.projection: found depth that grows with distance, expected one that falls: info.depth "
                      "is PLD_DEPTH_REVERSED",
                      call);
  return PLD_OK;
}

pld_status checkProjection(const FrameJudge& judge, const char* call, const pld_frame& frame) {
  for (const float x : frame.projection)
    if (!std::isfinite(x))
      return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection holds a number that is not finite", call);
  if (!isPerspective(frame.projection) && !isOrthographic(frame.projection))
    return judge.fail(PLD_ERROR_ARGUMENT,
                      "%s: frame.projection: expected perspective with w = -z, or orthographic, by columns", call);
  if (frame.projection[0] == 0.0f || frame.projection[5] == 0.0f)
    return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length of 0", call);
  return checkConvention(judge, call, frame);
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
pld_status checkNumber(const FrameJudge& judge, const char* call, const Number& number) {
  if (isWithin(number)) return PLD_OK;
  const auto found = static_cast<double>(number.value);
  if (!number.isRead) {
    // Hosts of 0.4 and earlier were not asked for what only scattering reads.
    if (number.isScattered && !judge.permutation.scatters() && !judge.isHostSince(5)) return PLD_OK;
    return judge.fail(PLD_ERROR_ARGUMENT,
                      "%s: frame.%s: found %g, which this pass does not read: expected a number all the same, as 0",
                      call, number.name, found);
  }
  static constexpr const char* expected[] = {"a number > 0", "a number >= 0", "a number"};
  return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.%s: found %g, expected %s", call, number.name, found,
                    expected[static_cast<int>(number.range)]);
}

pld_status checkNumbersAlone(const FrameJudge& judge, const char* call, const pld_frame& frame, uint32_t fields) {
  const Permutation& p = judge.permutation;
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
      if (const pld_status status = checkNumber(judge, call, number); status != PLD_OK) return status;
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

}  // namespace

// Of 0.1 it ended before occlusion_texture, of 0.5 before weight_reference, of 0.13 before depth_opacity.
bool takeWhole(const pld_frame& frame, pld_frame& whole) {
  if (frame.struct_size != offsetof(pld_frame, occlusion_texture) &&
      frame.struct_size != offsetof(pld_frame, weight_reference) &&
      frame.struct_size != offsetof(pld_frame, depth_opacity) && frame.struct_size != sizeof(pld_frame))
    return false;
  std::memcpy(&whole, &frame, frame.struct_size);
  return true;
}

pld_status FrameJudge::fail(pld_status status, const char* format, ...) const {
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, size, format, arguments);
  va_end(arguments);
  return status;
}

pld_status judgeNumbers(const FrameJudge& judge, const char* call, const pld_frame& frame, uint32_t fields) {
  const auto has = [&](pld_fixed field) { return names(fields, field); };
  if (has(PLD_FIXED_LENS) && (frame.width < 1 || frame.height < 1))
    return judge.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at least 1x1", call, frame.width, frame.height);
  if (has(PLD_FIXED_PROJECTION) || has(PLD_FIXED_LENS))
    if (const pld_status status = checkProjection(judge, call, frame); status != PLD_OK) return status;
  if (has(PLD_FIXED_REFRACTION) && (frame.refract < PLD_REFRACT_NOTHING || frame.refract > PLD_REFRACT_THROUGH_SLAB))
    return judge.fail(PLD_ERROR_ARGUMENT, "%s: found refract %d, which pld_refract does not have", call,
                      static_cast<int>(frame.refract));
  if (const pld_status status = checkNumbersAlone(judge, call, frame, fields); status != PLD_OK) return status;
  if (has(PLD_FIXED_LENS) && !(isPositive(focalOf(frame, 1).x) && isPositive(focalOf(frame, 1).y)))
    return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.projection: a focal length that is not finite in pixels", call);
  if (has(PLD_FIXED_WEIGHT) && !(frame.weight_far > frame.weight_near))
    return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.weight_near %g, weight_far %g: expected near < far", call,
                      static_cast<double>(frame.weight_near), static_cast<double>(frame.weight_far));
  return PLD_OK;
}

pld_status judgeOcclusion(const FrameJudge& judge, const char* call, const pld_frame& frame) {
  if (!judge.permutation.rims() ||
      (frame.occlusion >= PLD_OCCLUSION_RELATIVE && frame.occlusion <= PLD_OCCLUSION_PUBLISHED))
    return PLD_OK;
  return judge.fail(PLD_ERROR_ARGUMENT, "%s: found occlusion %d, which pld_occlusion does not have", call,
                    static_cast<int>(frame.occlusion));
}

pld_status judgeLow(const FrameJudge& judge, const char* call, const pld_frame& frame) {
  if (!judge.permutation.low()) return PLD_OK;
  if (frame.low_factor != 2 && frame.low_factor != 4 && frame.low_factor != 8)
    return judge.fail(PLD_ERROR_ARGUMENT, "%s: low_factor: found %d, expected 2, 4 or 8", call, frame.low_factor);
  if (frame.width % frame.low_factor != 0 || frame.height % frame.low_factor != 0)
    return judge.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected multiples of low_factor %d", call, frame.width,
                      frame.height, frame.low_factor);
  return PLD_OK;
}

pld_status judgeOpacity(const FrameJudge& judge, const char* call, const pld_frame& frame) {
  const float opacity = frame.depth_opacity;
  if (judge.permutation.reachesOpacity() ? opacity >= 0.0f && opacity <= 1.0f : std::isfinite(opacity)) return PLD_OK;
  return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.depth_opacity: found %g, expected a number%s", call,
                    static_cast<double>(opacity),
                    judge.permutation.reachesOpacity() ? " from 0 to 1" : ", though this pass does not read it");
}

pld_status judgeFixed(const FrameJudge& judge, const char* call, const char* by, const pld_frame& frame) {
  const char* const field = changedField(judge.permutation, frame);
  if (!field) return PLD_OK;
  return judge.fail(PLD_ERROR_ARGUMENT, "%s: frame.%s: found another than %s fixed", call, field, by);
}

}  // namespace pellucid::c
