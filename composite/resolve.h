// Sums to a veil (shaders/shared/resolve.glsl), and a veil over a background to the picture.
#pragma once
#include <glm/glm.hpp>

#include "composite/veil.h"
#include "gbuffer/accum.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

struct ResolveSettings {
  bool selfModulation = false;  // PT17 eq. 14; a heuristic for the published normalisation
};

Veil resolve(const OitPlanes& planes, const ResolveSettings& settings);

struct Picture {
  Image<glm::vec4> rgba;  // scene-linear, premultiplied; equals the background where touched is 0
  Image<std::uint8_t> touched;
};

// Non-finite background colours stay in their own pixel; behind a solid they are hidden like any other.
Picture compose(const Veil& veil, const GBuffer& background);

}  // namespace pellucid
