// Transparent fragments of each pixel, in any order: what the sorted truth and every method can be computed from.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

// Laid out as two std430 rows and a half, so that the GL pass writes it directly.
struct Fragment {
  glm::vec3 radiance;      // C = coverage * L_r + E, premultiplied, scene-linear
  float coverage;          // [0,1]; 0 marks additive light
  glm::vec3 transmission;  // t, [0,1]
  float z;                 // planar metres, > 0
  glm::vec2 offset;        // refraction delta, float pixels, y down
  float variance;          // diffusion, one layer's s^2, float pixels^2
  std::uint32_t identity;  // hash of file, node, mesh and triangle: the same for every chunking and order
};
static_assert(sizeof(Fragment) == 48);

// Lists of the pixels of one window, concatenated row by row.
struct FragmentLists {
  Window window;                       // in display coordinates
  std::vector<std::uint64_t> offsets;  // size width * height + 1: pixel i owns [offsets[i], offsets[i + 1])
  std::vector<Fragment> fragments;
  // Empty unless a layer disperses, else one per fragment: refraction delta of red minus `offset`, of blue minus it.
  std::vector<glm::vec4> dispersion;
  Image<glm::vec4> solid;  // nearest fragment that hides everything: rgb, planar z (+inf: none)

  bool disperses() const { return !dispersion.empty(); }
};

}  // namespace pellucid
