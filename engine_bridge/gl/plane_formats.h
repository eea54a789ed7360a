// Formats and blending of shaders/plane_layout.h in GL's numbers, which are the same for every loader: no GL header is
// included here, so that both the rooms' and the host's may be.
#pragma once
#include "shaders/plane_layout.h"

namespace pellucid::gl {

// Sized internal format.
constexpr unsigned formatOf(PlaneFormat format) {
  switch (format) {
    case PlaneFormat::r16f:
      return 0x822D;  // GL_R16F
    case PlaneFormat::rg16f:
      return 0x822F;  // GL_RG16F
    case PlaneFormat::rgba16f:
      return 0x881A;  // GL_RGBA16F
    case PlaneFormat::r32f:
      return 0x822E;  // GL_R32F
    case PlaneFormat::rg32f:
      return 0x8230;  // GL_RG32F
    case PlaneFormat::rgba32f:
      return 0x8814;  // GL_RGBA32F
    case PlaneFormat::rgba8:
      return 0x8058;  // GL_RGBA8
    default:
      return 0x8F95;  // GL_RG8_SNORM
  }
}

// As transfers name them.
constexpr unsigned channelsOf(int components) {
  return components == 1 ? 0x1903u : components == 2 ? 0x8227u : 0x1908u;  // GL_RED, GL_RG, GL_RGBA
}

// Of rgb; alpha is blended ONE, ONE.
struct BlendWords {
  unsigned source, destination, equation, alphaEquation;
};

constexpr BlendWords blendOf(PlaneBlend blend) {
  constexpr unsigned one = 1, zero = 0, oneMinusSourceColour = 0x0301, add = 0x8006, minimum = 0x8007;
  switch (blend) {
    case PlaneBlend::minimum:
      return {one, one, minimum, minimum};
    case PlaneBlend::alphaMinimum:
      return {one, one, add, minimum};
    case PlaneBlend::product:
      return {zero, oneMinusSourceColour, add, add};
    default:
      return {one, one, add, add};
  }
}

}  // namespace pellucid::gl
