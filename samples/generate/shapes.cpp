#include "samples/generate/shapes.h"

#include <cmath>
#include <limits>
#include <utility>

namespace pellucid::samples {
namespace {

constexpr double kNearest = 1e-6;  // metres; nearer hits are the surface a ray starts from

// The part of a ray inside a convex shape, with the outward normals at both ends.
struct Span {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  glm::dvec3 enterNormal{0.0}, leaveNormal{0.0};

  // Intersects with the slab |position + t * direction| <= half along an axis.
  void clip(double position, double direction, double half, glm::dvec3 axis) {
    if (direction == 0.0) {
      if (std::abs(position) > half) leave = -std::numeric_limits<double>::infinity();
      return;
    }
    const double side = direction > 0.0 ? 1.0 : -1.0;
    const double first = (-side * half - position) / direction, last = (side * half - position) / direction;
    if (first > enter) enter = first, enterNormal = -side * axis;
    if (last < leave) leave = last, leaveNormal = side * axis;
  }
};

glm::dvec3 turned(glm::dvec3 v, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

Span boxSpan(const Shape& shape, const Ray& ray) {
  const bool isTurned = shape.yaw != 0.0;
  const glm::dvec3 local = ray.origin - shape.centre;
  const glm::dvec3 origin = isTurned ? turned(local, -shape.yaw) : local;
  const glm::dvec3 direction = isTurned ? turned(ray.direction, -shape.yaw) : ray.direction;
  Span span;
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 axis(0.0);
    axis[i] = 1.0;
    span.clip(origin[i], direction[i], shape.half[i], axis);
  }
  if (isTurned) {
    span.enterNormal = turned(span.enterNormal, shape.yaw);
    span.leaveNormal = turned(span.leaveNormal, shape.yaw);
  }
  return span;
}

// Roots of |origin + t * direction| = radius.
std::optional<std::pair<double, double>> roots(double a, double halfB, double c) {
  const double discriminant = halfB * halfB - a * c;
  if (a <= 0.0 || discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return std::pair((-halfB - root) / a, (-halfB + root) / a);
}

Span empty() {
  Span span;
  span.leave = -std::numeric_limits<double>::infinity();
  return span;
}

Span sphereSpan(const Shape& shape, const Ray& ray) {
  const glm::dvec3 origin = ray.origin - shape.centre;
  const double radius = shape.half.x;
  const auto found = roots(1.0, glm::dot(origin, ray.direction), glm::dot(origin, origin) - radius * radius);
  if (!found) return empty();
  Span span;
  span.enter = found->first, span.leave = found->second;
  span.enterNormal = (origin + span.enter * ray.direction) / radius;
  span.leaveNormal = (origin + span.leave * ray.direction) / radius;
  return span;
}

Span cylinderSpan(const Shape& shape, const Ray& ray) {
  const glm::dvec3 origin = ray.origin - shape.centre;
  const double radius = shape.half.x;
  const glm::dvec2 o(origin.x, origin.z), d(ray.direction.x, ray.direction.z);
  Span span;
  if (glm::dot(d, d) > 0.0) {
    const auto found = roots(glm::dot(d, d), glm::dot(o, d), glm::dot(o, o) - radius * radius);
    if (!found) return empty();
    const glm::dvec2 in = (o + found->first * d) / radius, out = (o + found->second * d) / radius;
    span.enter = found->first, span.enterNormal = {in.x, 0.0, in.y};
    span.leave = found->second, span.leaveNormal = {out.x, 0.0, out.y};
  } else if (glm::dot(o, o) > radius * radius) {
    return empty();
  }
  span.clip(origin.y, ray.direction.y, shape.half.y, {0.0, 1.0, 0.0});
  return span;
}

std::optional<Hit> hit(const Shape& shape, const Ray& ray) {
  const Span span = shape.kind == ShapeKind::box      ? boxSpan(shape, ray)
                    : shape.kind == ShapeKind::sphere ? sphereSpan(shape, ray)
                                                      : cylinderSpan(shape, ray);
  if (span.enter > span.leave) return std::nullopt;
  if (span.enter > kNearest) return Hit{span.enter, span.enterNormal, &shape};
  if (span.leave > kNearest) return Hit{span.leave, span.leaveNormal, &shape};
  return std::nullopt;
}

}  // namespace

std::optional<Hit> nearestHit(const std::vector<Shape>& shapes, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const Shape& shape : shapes)
    if (const auto found = hit(shape, ray); found && (!nearest || found->distance < nearest->distance)) nearest = found;
  return nearest;
}

bool anyHit(const std::vector<Shape>& shapes, const Ray& ray, double reach) {
  for (const Shape& shape : shapes)
    if (const auto found = hit(shape, ray); found && found->distance < reach) return true;
  return false;
}

}  // namespace pellucid::samples
