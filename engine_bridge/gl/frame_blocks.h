// What the shaders read from uniform and storage blocks, byte for byte. Mirrors shaders/gl/frame.glsl; materials and
// lights are engine_bridge/scene/blocks.h.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "engine_bridge/scene/blocks.h"

namespace pellucid::gl {

struct FrameBlock {
  glm::mat4 clipFromView{1.0f};
  glm::vec4 surroundings{0.0f};
  float weightNear = 0, weightFar = 0, weightExponent = 0, depthFactor = 1;
  std::int32_t bandX = 0, bandY = 0, bandWidth = 0, probeCell = 1;
  std::int32_t lightCount = 0, orthographic = 0;
  glm::vec2 viewport{0.0f};       // pixels
  glm::vec4 refraction{0.0f};     // PLD_REFRACT_*; metres (fixed); focal length in x and y, pixels
  glm::vec4 diffusion{0.0f};      // k0, k1 metres; 1 for net coverage; how much occlusion darkens direct light
  glm::mat4 worldFromView{1.0f};  // turns only
  std::int32_t atlasEdge = 0;
  float footprint = 1.0f;  // edge of what one sample stands for, pixels
  std::int32_t originX = 0, originY = 0;
  glm::mat4 volumeFromView{1.0f};  // to texels of the light volume, centres at +0.5
  glm::ivec4 volumeTexels{1};      // of one light
  float weightReference = 1.0f;    // metres
  float unused = 0.0f;
  glm::vec2 toMiddle{0.0f};  // from the sample to the pixel's middle, pixels
};
static_assert(sizeof(FrameBlock) == 336);
static_assert(offsetof(FrameBlock, weightNear) == 80 && offsetof(FrameBlock, bandX) == 96);
static_assert(offsetof(FrameBlock, weightReference) == 320 && offsetof(FrameBlock, toMiddle) == 328);
static_assert(offsetof(FrameBlock, lightCount) == 112 && offsetof(FrameBlock, viewport) == 120);

// Storage binding of the first column of lists (gbuffer/fragments.h), the others after it; as in
// shaders/gl/scattered.glsl.
constexpr std::uint32_t kFirstColumn = 7;

}  // namespace pellucid::gl
