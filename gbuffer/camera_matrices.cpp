#include "gbuffer/camera_matrices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// Rotations that were floats are orthonormal to this.
constexpr double kOrthonormal = 1e-4;

bool allFinite(const glm::dmat4& matrix) {
  const double* entries = &matrix[0][0];
  return std::all_of(entries, entries + 16, [](double entry) { return std::isfinite(entry); });
}

// How far the matrix is from columns of unit length at right angles.
double shear(const glm::dmat3& matrix) {
  double worst = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(glm::dot(matrix[i], matrix[j]) - (i == j ? 1.0 : 0.0)));
  return worst;
}

}  // namespace

Camera cameraFromMatrices(const glm::dmat4& viewFromWorld, const glm::dmat4& clipFromView) {
  const auto refuse = [](const char* matrix, const std::string& found, const char* expected) {
    throw UsageError(fmt::format("camera: {}: found {}, expected {}", matrix, found, expected));
  };
  if (!allFinite(viewFromWorld)) refuse("view from world", "a number that is not finite", "a camera");
  if (!allFinite(clipFromView)) refuse("clip from view", "a number that is not finite", "a camera");
  const glm::dmat3 turn(viewFromWorld);
  if (glm::row(viewFromWorld, 3) != glm::dvec4(0.0, 0.0, 0.0, 1.0) || shear(turn) > kOrthonormal ||
      glm::determinant(turn) < 0.0)
    refuse("view from world", "a scale, a shear or a mirror", "a rotation and a translation, of column vectors");
  Camera camera;
  camera.viewFromWorld = viewFromWorld;
  camera.origin = "matrices";
  const glm::dvec4 x = glm::row(clipFromView, 0), y = glm::row(clipFromView, 1), w = glm::row(clipFromView, 3);
  camera.orthographic = w.z == 0.0;
  const double divisor = camera.orthographic ? w.w : -w.z;
  const glm::dvec4 last = camera.orthographic ? glm::dvec4(0.0, 0.0, 0.0, w.w) : glm::dvec4(0.0, 0.0, w.z, 0.0);
  if (w != last || !(divisor > 0.0))
    refuse("clip from view", fmt::format("the last row {:g} {:g} {:g} {:g}", w.x, w.y, w.z, w.w),
           "0 0 -1 0 of a perspective or 0 0 0 1 of an orthographic camera");
  const double unread[] = {x.y, y.x, camera.orthographic ? x.z : x.w, camera.orthographic ? y.z : y.w};
  if (std::any_of(std::begin(unread), std::end(unread), [](double entry) { return entry != 0.0; }))
    refuse("clip from view", "a roll or a shear", "a scale and a shift of x and y");
  camera.focal = glm::dvec2(x.x, y.y) / divisor;
  camera.centre = camera.orthographic ? glm::dvec2(x.w, y.w) / divisor : glm::dvec2(-x.z, -y.z) / divisor;
  if (!(camera.focal.x > 0.0 && camera.focal.y > 0.0))
    refuse("clip from view", fmt::format("the scale {:g}, {:g}", camera.focal.x, camera.focal.y), "positive numbers");
  return camera;
}

}  // namespace pellucid
