#include "gbuffer/shadow_maps.h"

namespace pellucid {
namespace shading {
namespace {

// The shared text of the lookup, with the functions by which it reads the maps.
struct ShadowLookupText {
  const ShadowMaps& maps;

  const vec4& shadowTexel(int index) const { return maps.texels[static_cast<std::size_t>(index)]; }
  const ShadowLight& shadowLight(int light) const { return maps.lights[static_cast<std::size_t>(light)]; }
  const ShadowFace& shadowFace(int face) const { return maps.faces[static_cast<std::size_t>(face)]; }

#define PLD_FN inline
#define precise
#include "shaders/shared/shadow_lookup.glsl"
#undef precise
#undef PLD_FN
};

}  // namespace
}  // namespace shading

glm::vec3 ShadowMaps::visibility(std::size_t light, const glm::vec3& point) const {
  return shading::ShadowLookupText{*this}.shadowVisibility(static_cast<int>(light), point);
}

glm::vec3 ShadowMaps::onOpaque(std::size_t light, const glm::vec3& point) const {
  return shading::ShadowLookupText{*this}.transparentVisibility(static_cast<int>(light), point, true);
}

}  // namespace pellucid
