#include "tests/reference/closed_solids.h"

#include <cmath>

namespace pellucid::reference {
namespace {

struct Side {
  double z;
  int side;
};

Side meet(const Plane& plane, const Ray& ray) {
  const double facing = glm::dot(plane.normal, ray.along);
  return {glm::dot(plane.normal, plane.point - ray.from) / facing, 0};
}

Side meet(const Ball& ball, const Ray& ray) {
  const Vec3 towards = ball.centre - ray.from;
  const double length = glm::dot(ray.along, ray.along), middle = glm::dot(towards, ray.along) / length;
  const Vec3 aside = towards - middle * ray.along;
  const double square = (ball.radius * ball.radius - glm::dot(aside, aside)) / length;
  if (!(square > 0.0)) return {kNothing, 0};
  const double reach = std::sqrt(square);
  return {middle - reach > 0.0 ? middle - reach : middle + reach, 0};
}

Side meet(const Box& box, const Ray& ray) {
  const Vec3 from = glm::transpose(box.axes) * (ray.from - box.centre), along = glm::transpose(box.axes) * ray.along;
  Side enters{-kNothing, 0}, leaves{kNothing, 0};
  for (int k = 0; k < 3; ++k) {
    const double one = (-box.half[k] - from[k]) / along[k], other = (box.half[k] - from[k]) / along[k];
    const int near = along[k] > 0.0 ? 2 * k : 2 * k + 1;
    if (std::min(one, other) > enters.z) enters = {std::min(one, other), near};
    if (std::max(one, other) < leaves.z) leaves = {std::max(one, other), near ^ 1};
  }
  if (!(enters.z < leaves.z)) return {kNothing, 0};
  return enters.z > 0.0 ? enters : leaves;
}

}  // namespace

Ray rayThrough(const Eye& eye, double x, double y) {
  const double u = (2.0 * (x + eye.firstX) / eye.displayWidth - 1.0) * eye.half.x;
  const double v = (1.0 - 2.0 * (y + eye.firstY) / eye.displayHeight) * eye.half.y;
  if (eye.parallel) return {eye.at + eye.axes * Vec3(u, v, 0.0), -eye.axes[2]};
  return {eye.at, eye.axes * Vec3(u, v, -1.0)};
}

Met nearestSolid(const PictureScene& scene, const Ray& ray) {
  Met nearest;
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const Side met = std::visit([&](const auto& shape) { return meet(shape, ray); }, scene.solids[i].shape);
    if (met.z > 0.0 && met.z < nearest.z) nearest = {met.z, {static_cast<int>(i), met.side}};
  }
  return nearest;
}

std::optional<double> depthOfPlane(const PictureScene& scene, const Face& face, const Ray& ray) {
  if (face.solid < 0) return kNothing;
  const auto& shape = scene.solids[static_cast<std::size_t>(face.solid)].shape;
  double z = -1.0;
  if (const auto* plane = std::get_if<Plane>(&shape)) z = meet(*plane, ray).z;
  if (const auto* box = std::get_if<Box>(&shape)) {
    const int axis = face.side / 2;
    const Vec3 outwards = box->axes[axis] * (face.side % 2 == 0 ? -1.0 : 1.0);
    z = meet(Plane{box->centre + outwards * box->half[axis], outwards}, ray).z;
  }
  if (!(z > 0.0) || z == kNothing) return std::nullopt;
  return z;
}

}  // namespace pellucid::reference
