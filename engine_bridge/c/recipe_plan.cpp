#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

const char* const kListNames[5] = {"PldLinks", "PldRadiances", "PldTransmissions", "PldOffsets", "PldDispersions"};

pld_format formatOf(PlaneFormat format) {
  switch (format) {
    case PlaneFormat::r16f:
      return PLD_FORMAT_R16F;
    case PlaneFormat::rg16f:
      return PLD_FORMAT_RG16F;
    case PlaneFormat::rgba16f:
      return PLD_FORMAT_RGBA16F;
    case PlaneFormat::r32f:
      return PLD_FORMAT_R32F;
    case PlaneFormat::rg32f:
      return PLD_FORMAT_RG32F;
    case PlaneFormat::rgba32f:
      return PLD_FORMAT_RGBA32F;
    case PlaneFormat::rgba8:
      return PLD_FORMAT_RGBA8;
    default:
      return PLD_FORMAT_RG8_SNORM;
  }
}

int bitsOf(pld_format format) {
  static constexpr int bits[] = {0, 16, 32, 64, 32, 64, 128, 32, 16, 32};
  return bits[format];
}

pld_blend blendOf(PlaneBlend blend) {
  constexpr pld_factor one = PLD_FACTOR_ONE;
  switch (blend) {
    case PlaneBlend::minimum:
      return {1, one, one, PLD_BLEND_MINIMUM, one, one, PLD_BLEND_MINIMUM};
    case PlaneBlend::alphaMinimum:
      return {1, one, one, PLD_BLEND_ADD, one, one, PLD_BLEND_MINIMUM};
    case PlaneBlend::product:
      return {1, PLD_FACTOR_ZERO, PLD_FACTOR_ONE_MINUS_SOURCE_COLOUR, PLD_BLEND_ADD, one, one, PLD_BLEND_ADD};
    default:
      return {1, one, one, PLD_BLEND_ADD, one, one, PLD_BLEND_ADD};
  }
}

}  // namespace pellucid::c
