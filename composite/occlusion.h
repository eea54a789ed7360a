// Ambient occlusion at the rims of cut-out leaves, inferred from the opaque pixels beside them. MODEL section 10.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "gbuffer/occluders.h"
#include "shaders/shading.h"

namespace pellucid {

// A rendered foliage layer: planes of its own window, which may differ from the occluders'.
struct FoliagePlanes {
  Window data;
  Image<float> coverage;  // [0,1]
  Image<float> viewZ;     // planar metres, > 0, +inf for nothing
};

// Depth of what the layer covers wholly, in the given window: planar metres, +inf elsewhere.
Image<float> solidDepth(const FoliagePlanes& layer, const Window& window);

// Pixels of the occluders that some rim of the layer looks at.
Image<std::uint8_t> occludersWanted(const FoliagePlanes& layer, const Window& occluders, int form);

// What the opaque pixels beside a rim say: (weighted occlusion, weight), for shading::occlusionFrom. Pixels without
// depth or with an occlusion that is not finite say nothing.
//   place  of the rim, in the occluders' window; may lie outside it
//   z      of the rim, planar metres, > 0
glm::vec2 neighboursOcclusion(const OccluderPlanes& occluders, glm::ivec2 place, const shading::OcclusionSearch& search,
                              float z, int form);

struct InferredOcclusion {
  Image<float> occlusion;          // of the layer's window, [0,1]; 1 where coverage is 0 or 1
  std::size_t rims = 0;            // pixels with 0 < coverage < 1
  std::size_t withoutDepth = 0;    // of them, rims that have no depth: left open
  std::size_t withoutSources = 0;  // of them, rims beside which nothing opaque lies: left open
};

// Coverage gradients are differences within the 2x2 quads that start at the occluders' first pixel, as GL takes them,
// so that the layer as a file and the layer in the pass get the same answer.
//   form  PLD_OCCLUSION_RELATIVE or PLD_OCCLUSION_PUBLISHED
InferredOcclusion inferOcclusion(const FoliagePlanes& layer, const OccluderPlanes& occluders, int form);

// Darkens premultiplied radiance; pixels that are not finite, or fully open, stay as they are. `touched` says which
// changed.
//   indirect     the part of beauty that came from all around, premultiplied
//   directShare  how much of the occlusion also darkens the rest, [0,1]
void applyOcclusion(const Image<float>& occlusion, const Image<glm::vec3>& indirect, float directShare,
                    Image<glm::vec4>& beauty, Image<std::uint8_t>& touched);

}  // namespace pellucid
