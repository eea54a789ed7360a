// Textures read on the CPU, as GL reads them.
#pragma once
#include <glm/glm.hpp>

#include "engine_bridge/scene/scene.h"

namespace pellucid::rays {

enum class TexelFilter { bilinear, nearest };

// Whether colours are filtered weighted by alpha.
enum class TexelWeight { plain, byAlpha };

// Level 0 at uv, wrapped as the texture says. A texture whose file asks for `nearest` gets it.
glm::vec4 sampleTexture(const Texture& texture, glm::vec2 uv, TexelFilter filter,
                        TexelWeight weight = TexelWeight::plain);

}  // namespace pellucid::rays
