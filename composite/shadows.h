// Shadows of transparent things on a render that is already lit: each light's own layer, dimmed, and the beauty summed
// again. MODEL section 6
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "gbuffer/medium.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid {

// What transparent casters leave of a light on each pixel of a G-buffer, at the mean of `samples` positions in it, 1
// being its centre. 1 where nothing was hit.
//   camera  in whose view space the maps are
//   air     multiplies what arrives at each position; empty: nothing is in the air
Image<glm::vec3> mappedVisibility(const ShadowMaps& maps, std::size_t light, const GBuffer& gbuffer,
                                  const Camera& camera, int samples, const AirPassed& air = {});

struct ShadowedLight {
  const Image<glm::vec3>* visibility;  // what passes the transparent things, [0,1]
  const Image<glm::vec3>* light;       // this light's part of the beauty, >= 0
};

struct ShadowCounts {
  std::size_t changed = 0;    // pixels
  std::size_t clamped = 0;    // where the layers held more light than the beauty: it became 0
  std::size_t nonFinite = 0;  // pixels whose layers are not finite: left as they were
};

// beauty += sum of (V - 1) L, where a V is not 1. Marks those pixels in `touched`. Alpha stays.
ShadowCounts relight(const std::vector<ShadowedLight>& lights, Image<glm::vec4>& beauty, Image<std::uint8_t>& touched);

// beauty *= multiplier, where that is not 1.
ShadowCounts darken(const Image<glm::vec3>& multiplier, Image<glm::vec4>& beauty, Image<std::uint8_t>& touched);

}  // namespace pellucid
