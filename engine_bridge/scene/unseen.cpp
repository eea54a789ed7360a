#include "engine_bridge/scene/unseen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/corners.h"

namespace pellucid {
namespace {

// Of the corners of all transparent triangles, placed. Particles and cards reach beyond them: told alike.
struct Reach {
  double nearest = std::numeric_limits<double>::infinity();    // planar metres of those before the eye
  double farthest = -std::numeric_limits<double>::infinity();  // of all; negative behind the eye
  // How many lie outside each edge of the data window: left, right, top, bottom.
  std::size_t outside[4] = {}, before = 0;

  void add(const Projected& point, const Window& data) {
    farthest = std::max(farthest, point.z);
    if (!(point.z > 0.0)) return;
    nearest = std::min(nearest, point.z);
    ++before;
    outside[0] += point.pixel.x < data.x0;
    outside[1] += point.pixel.x > data.x1;
    outside[2] += point.pixel.y < data.y0;
    outside[3] += point.pixel.y > data.y1;
  }
  // All beside one edge, none behind the eye: then no triangle crosses the picture.
  bool beside(std::size_t corners) const {
    return before == corners &&
           std::any_of(std::begin(outside), std::end(outside), [&](std::size_t count) { return count == before; });
  }
};

Reach reachOf(const Scene& scene, const Camera& camera, const GBuffer& gbuffer, std::size_t& corners) {
  Reach reach;
  forEachCorner(
      scene, glm::dmat4(1.0), [](const Material& material) { return material.transparent(); },
      [&](const Instance&, const glm::dvec3& world) {
        ++corners;
        reach.add(project(camera, gbuffer.display, world), gbuffer.data);
      });
  return reach;
}

// 0 for a picture that shows nothing but sky.
float farthestDepth(const GBuffer& gbuffer) {
  float farthest = 0.0f;
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i) {
    if (!std::isfinite(gbuffer.viewZ[i])) return std::numeric_limits<float>::infinity();
    farthest = std::max(farthest, gbuffer.viewZ[i]);
  }
  return farthest;
}

}  // namespace

std::string whyNothingShows(const Scene& scene, const Camera& camera, const GBuffer& gbuffer) {
  if (scene.instances.empty()) return "it holds no mesh that is drawn";
  std::size_t corners = 0;
  const Reach reach = reachOf(scene, camera, gbuffer, corners);
  if (corners == 0)
    return fmt::format(
        "none of the {} materials that its meshes use is transparent (alphaMode BLEND or MASK, or "
        "KHR_materials_transmission)",
        scene.materials.size());
  if (!(reach.farthest > 0.0)) return "all that is transparent lies behind the eye: is it the right --camera?";
  if (reach.beside(corners)) return "all that is transparent lies outside the picture: is it the right --camera?";
  const float wall = farthestDepth(gbuffer);
  if (reach.nearest > static_cast<double>(wall))
    return fmt::format(
        "all that is transparent lies behind what the picture shows: {:.4g} m away or more, and the "
        "farthest depth is {:.4g} m: is --unit right?",
        reach.nearest, wall);
  return "what is transparent covers no pixel, or lies behind what the picture shows there";
}

}  // namespace pellucid
