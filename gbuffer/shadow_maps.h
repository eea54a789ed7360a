// Shadow maps of a scene's lights: what transparent and opaque things leave of each light at any point. Made by
// engine_bridge/gl/shadow_pass.h; looked up here and, byte for byte, in shaders/gl/shadow_maps.glsl. MODEL section 6
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/shadow_map.h"

namespace pellucid {

static_assert(sizeof(shading::ShadowLight) == 64 && sizeof(shading::ShadowFace) == 96);

struct ShadowMaps {
  std::vector<shading::ShadowLight> lights;  // one for each of Scene::lights; without faces where it sends nothing
  std::vector<shading::ShadowFace> faces;
  // Of each face in turn, row by row: a vec4 per texel and channel, sums of shadowTexelOf(); of opaque faces a float
  // per texel, the nearest depth, four in a vec4.
  std::vector<glm::vec4> texels;

  // RGB part of a light that reaches a point in the air or on a transparent surface, [0,1]: the darker of what
  // transparent and opaque casters leave. 1 where no map reaches.
  //   light  index into Scene::lights
  //   point  in the view space of the camera that the maps were made for, metres
  glm::vec3 visibility(std::size_t light, const glm::vec3& point) const;
  // What transparent casters alone leave on an opaque surface, whose render already knows the opaque shadows.
  glm::vec3 onOpaque(std::size_t light, const glm::vec3& point) const;
};

}  // namespace pellucid
