// What compositing by depth reads of transparent fragments, where the device has left it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

// The first two rows of a Fragment.
struct LeanFragment {
  glm::vec3 radiance;
  float coverage;
  glm::vec3 transmission;
  float z;
};
static_assert(sizeof(LeanFragment) == 32);

// Lists of the pixels of one window, row by row; what lies between them means nothing.
struct LeanLists {
  struct Range {
    std::uint32_t begin, count;
  };
  Window window;              // in display coordinates
  std::vector<Range> ranges;  // of `fragments`, one per pixel
  std::span<const LeanFragment> fragments;
  Image<glm::vec4> solid;  // nearest fragment that hides everything: rgb, planar z (+inf: none); empty: none anywhere
};

}  // namespace pellucid
