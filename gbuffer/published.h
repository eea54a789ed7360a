// One pixel of the `published` tier as its targets hold it, and how it lies in planes. PT17 table 2
#pragma once
#include <cstdint>

#include "gbuffer/accum.h"

namespace pellucid {

struct PublishedPixel {
  glm::vec4 radiance{0.0f};                   // halves: sums of w C and of w o
  std::uint8_t beta[4] = {255, 255, 255, 0};  // product of 1 - alpha (1 - t); sum of s^2 / 63^2
  std::int8_t delta[2] = {0, 0};              // sum of o delta / 63
};

// Numbers that did not fit, and were cut to the largest that does.
struct PublishedClamps {
  std::uint64_t written = 0;                                  // what single layers wrote
  std::uint64_t radiance = 0, diffusion = 0, refraction = 0;  // sums at the end of their range, pixels
  std::uint64_t total() const { return written + radiance + diffusion + refraction; }
  PublishedClamps& operator+=(const PublishedClamps& other) {
    written += other.written, radiance += other.radiance, diffusion += other.diffusion, refraction += other.refraction;
    return *this;
  }
};

// Derives what such planes hold besides: whether the pixel is touched, bends or spreads.
//   given  radiance.rgb, weight.r, depth.rgb; refraction.xyw where there are scatter planes
void completePublished(OitPlanes& planes, int x, int y);

// Decodes into planes of tier "published", whose scatter planes must be there where the pixel scatters.
void storePublished(const PublishedPixel& pixel, OitPlanes& planes, int x, int y, PublishedClamps& clamps);

}  // namespace pellucid
