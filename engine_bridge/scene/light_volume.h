// How much of each light reaches fog and particles: sampled once on a grid of the world, from any source of shadows, so
// that what looks it up pays the same for one shadow or a thousand.
#pragma once
#include <cstdint>
#include <functional>

#include "gbuffer/medium.h"

namespace pellucid {

// Part of a light that reaches a point past surfaces, per channel, [0,1].
//   light  index into Fog::lights
//   point  view space, metres
using PointVisibility = std::function<glm::vec3(std::size_t light, const glm::dvec3& point)>;

// The same of a point on a transparent surface, which does not shadow itself there. Called from several threads at
// once.
//   light     counts lights as lightBlocks() does: those that shine
//   identity  of the triangle, as Fragment::identity
using SurfaceVisibility = std::function<glm::vec3(std::size_t light, const glm::dvec3& point, std::uint32_t identity)>;

// Optical depth of a grid that stands on the straight way from a point to a light.
//   step  metres
float gridDepth(const Fog& fog, const shading::PunctualLight& light, const glm::dvec3& point, double step);

// Texels are cubes as near as whole numbers go, `longest` along the longest edge of the box. Those beside the box count
// for points outside. The same bits for every number of threads.
std::shared_ptr<const LightVolume> sampleLights(const Fog& fog, const Box& box, int longest,
                                                const PointVisibility& visible);

}  // namespace pellucid
