#include "engine_bridge/scene/light_views.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine_bridge/scene/corners.h"
#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

constexpr double kWidestSpot = 1.0471975511965976;  // 60 degrees from the axis; wider cones take the faces of a cube

// Rotation that takes `direction` to -z.
glm::dmat3 lookAlong(const glm::dvec3& direction) {
  const glm::dvec3 away = glm::normalize(direction);
  const glm::dvec3 aside = std::abs(away.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(away, aside));
  return glm::transpose(glm::dmat3(right, glm::cross(right, away), -away));
}

LightView faceOf(const glm::dmat4& viewFromWorld, double focal) {
  LightView view;
  view.camera.viewFromWorld = viewFromWorld;
  view.camera.focal = glm::dvec2(focal);
  return view;
}

LightViews directionalViews(const Light& light, const Bounds& casters, const Bounds& needed, double margin) {
  const glm::dvec2 low = glm::max(glm::dvec2(casters.low), glm::dvec2(needed.low));
  const glm::dvec2 high = glm::min(glm::dvec2(casters.high), glm::dvec2(needed.high));
  if (!(low.x <= high.x && low.y <= high.y)) return {};
  const double depth = casters.high.z - casters.low.z, size = std::max(high.x - low.x, high.y - low.y);
  // Of a thing without extent too.
  const double unit = std::max({0.5 * depth, 0.5 * size, 1e-6 * glm::length(casters.high), 1e-12});
  LightView view;
  view.camera.orthographic = true;
  view.back = casters.high.z + unit;
  view.camera.viewFromWorld = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -view.back}) * lightFromWorld(light);
  const glm::dvec2 extent = glm::max(high - low, glm::dvec2(1e-3 * unit)) / (1.0 - 2.0 * margin);
  view.camera.focal = 2.0 / extent;
  view.camera.centre = -(low + high) / extent;
  LightViews views;
  views.faces.push_back(view);
  views.scale = 1.0 / unit;
  views.offset = 0.5 * (casters.low.z + casters.high.z) / unit;
  return views;
}

}  // namespace

bool castsInto(Casters kind, const Material& material) {
  if (kind == Casters::opaque) return !material.transparent() && material.castsShadow;
  return material.transparent() && material.castsShadow && !material.additive;
}

Bounds casterBounds(const Scene& scene, Casters kind, const glm::dmat4& toSpace, double& farthest) {
  Bounds bounds;
  double squared = 0.0;
  forEachReach(
      scene, toSpace, [&](const Material& material) { return castsInto(kind, material); },
      [&](const Instance&, const glm::dvec3&, const glm::dvec3& middle, double reach) {
        bounds.add(middle - reach);
        bounds.add(middle + reach);
        const double away = glm::length(middle) + reach;
        squared = std::max(squared, away * away);
      });
  farthest = std::sqrt(squared);
  return bounds;
}

Bounds pictureBounds(const GBuffer& gbuffer, const Camera& camera, const glm::dmat4& toSpace, double& farthest) {
  Bounds bounds;
  double squared = 0.0;
  const glm::dmat4 fromView = toSpace * glm::inverse(camera.viewFromWorld);
  const auto add = [&](const glm::dvec3& view) {
    const glm::dvec3 point(fromView * glm::dvec4(view, 1.0));
    bounds.add(point);
    squared = std::max(squared, glm::dot(point, point));
  };
  add(glm::dvec3(0.0));
  for (int y = 0; y < gbuffer.viewZ.height(); ++y)
    for (int x = 0; x < gbuffer.viewZ.width(); ++x)
      if (std::isfinite(gbuffer.viewZ.at(x, y))) add(viewPoint(gbuffer, camera, x, y));
  farthest = std::sqrt(squared);
  return bounds;
}

glm::dmat4 lightFromWorld(const Light& light) {
  const glm::dvec3 along = light.kind == LightKind::point ? glm::dvec3(0, 0, -1) : light.direction;
  const glm::dmat4 turned(lookAlong(along));
  if (light.kind == LightKind::directional) return turned;
  return turned * glm::translate(glm::dmat4(1.0), -light.position);
}

LightViews lightViews(const Light& light, const Bounds& casters, double farthest, const Bounds& needed, double margin) {
  if (casters.empty()) return {};
  if (light.kind == LightKind::directional) return directionalViews(light, casters, needed, margin);
  if (!(farthest > 0.0)) return {};
  LightViews views;
  views.radial = true;
  views.scale = 1.0 / farthest;
  const glm::dmat4 own = lightFromWorld(light);
  const double outer = static_cast<double>(light.outerCone);
  if (light.kind == LightKind::spot && outer <= kWidestSpot) {
    views.faces.push_back(faceOf(own, (1.0 - 2.0 * margin) / std::tan(std::max(outer, 1e-3))));
    return views;
  }
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
                                glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
    LightView view = faceOf(glm::dmat4(lookAlong(axis)) * own, 1.0 - 2.0 * margin);
    view.inner = margin;
    views.faces.push_back(view);
  }
  return views;
}

}  // namespace pellucid
