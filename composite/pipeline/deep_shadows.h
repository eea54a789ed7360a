// Shadows on a deep picture: each of its samples is dimmed where it lies.
#pragma once
#include <functional>

#include "composite/pipeline/shot.h"

namespace pellucid {

// What passes the transparent things on its way from a light to a point. Called from several threads at once. [0,1]
//   light  index into Scene::lights
//   point  view space, metres
using DeepVisibility = std::function<glm::vec3(std::size_t light, const glm::dvec3& point)>;

struct DeepShadows {
  DeepOpaque picture;           // every sample multiplied, and what they flatten to
  Image<glm::vec3> multiplier;  // mean over a pixel's samples, each by its share; 1 where nothing is
  Image<std::uint8_t> touched;  // pixels that changed
};

// All lights together: each by the light that it sends to a surface that faces it.
DeepShadows dimDeepPicture(const Shot& shot, const std::vector<std::size_t>& lights, const DeepVisibility& visible);

}  // namespace pellucid
