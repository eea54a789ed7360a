#include "gbuffer/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// EXR's camera space looks down +z and is left-handed; ours looks down -z.
const glm::dmat4 kFlipZ(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
// Attributes are floats: their rotations are orthonormal to this.
constexpr double kOrthonormal = 1e-4;

bool allFinite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

double largest(const glm::dmat4& m) {
  double value = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) value = std::max(value, std::abs(m[c][r]));
  return value;
}

// In GLM's column-vector form an affine matrix ends with the row (0, 0, 0, 1).
bool isAffine(const glm::dmat4& m) {
  const glm::dvec4 last = glm::row(m, 3);
  return glm::length(glm::dvec3(last)) <= kOrthonormal && std::abs(last.w - 1.0) <= kOrthonormal;
}

// How far the 3x3 part is from rows of equal length at right angles.
double shear(const glm::dmat3& m) {
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(glm::dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)));
  return worst;
}

struct Lens {
  bool orthographic = false;
  glm::dvec2 scale{}, shift{};  // ndc01 = scale * (x, y) / z + shift
};

// ndcFromCamera must be one of
//   perspective   (sx 0 cx 0) (0 sy cy 0) (any) (0 0 w 0)
//   orthographic  (sx 0 0 cx) (0 sy 0 cy) (any) (0 0 0 w)
// up to what float matrices lose, `slack`.
Lens lensOf(const glm::dmat4& ndcFromCamera, double slack, const std::string& file) {
  const auto contradicts = [&](const std::string& found) {
    throw MeaningError(
        fmt::format("{}: attributes worldToCamera and worldToNDC: found {}, expected one camera", file, found));
  };
  const glm::dvec4 x = glm::row(ndcFromCamera, 0), y = glm::row(ndcFromCamera, 1), w = glm::row(ndcFromCamera, 3);
  Lens lens;
  lens.orthographic = std::abs(w.w) > std::abs(w.z);
  const double divisor = lens.orthographic ? w.w : w.z;
  const double rest = std::max({std::abs(w.x), std::abs(w.y), std::abs(lens.orthographic ? w.z : w.w)});
  const double offAxis = std::max(
      {std::abs(x.y), std::abs(y.x), std::abs(lens.orthographic ? x.z : x.w), std::abs(lens.orthographic ? y.z : y.w)});
  if (!(std::abs(divisor) > slack)) contradicts("no projection");
  if (divisor < 0) contradicts("a projection that looks down -z");
  if (rest > slack || offAxis > slack) contradicts("a projection that is not along worldToCamera's z axis");
  lens.scale = glm::dvec2(x.x, y.y) / divisor;
  lens.shift = glm::dvec2(lens.orthographic ? x.w : x.z, lens.orthographic ? y.w : y.z) / divisor;
  if (!(lens.scale.x > 0)) contradicts("a mirrored picture");
  if (lens.scale.y == 0) contradicts("a picture without height");
  return lens;
}

}  // namespace

glm::dmat4 clipFromView(const Camera& camera, const Window& display, const Window& data, glm::dvec2 sample) {
  // NDC of the data window from NDC of the display window, through pixels.
  const glm::dvec2 full(display.width(), display.height()), part(data.width(), data.height());
  const glm::dvec2 scale = full / part;
  const glm::dvec2 shift((full.x + 2.0 * (display.x0 - data.x0 + 0.5 - sample.x)) / part.x - 1.0,
                         1.0 - (full.y + 2.0 * (display.y0 - data.y0 + 0.5 - sample.y)) / part.y);
  const glm::dvec2 focal = scale * camera.focal, centre = scale * camera.centre + shift;
  glm::dmat4 clip(0.0);
  clip[0][0] = focal.x;
  clip[1][1] = focal.y;
  if (camera.orthographic) {
    clip[3][0] = centre.x;
    clip[3][1] = centre.y;
    clip[3][3] = 1.0;
    // Only keeps what lies behind the camera out of 0..1; depth itself is left to gl_FragDepth.
    clip[2][2] = -1e-12;
  } else {
    clip[2][0] = -centre.x;  // times view.z = -z
    clip[2][1] = -centre.y;
    clip[2][3] = -1.0;
    clip[3][2] = kClipNear;
  }
  return clip;
}

Projected project(const Camera& camera, const Window& display, glm::dvec3 world) {
  const glm::dvec4 view = camera.viewFromWorld * glm::dvec4(world, 1.0);
  const double z = -view.z;
  const glm::dvec2 ndc = camera.focal * glm::dvec2(view) / (camera.orthographic ? 1.0 : z) + camera.centre;
  return {{display.x0 + (ndc.x + 1.0) * 0.5 * display.width(), display.y0 + (1.0 - ndc.y) * 0.5 * display.height()}, z};
}

Camera cameraFromExr(const glm::dmat4& worldToCameraRows, const glm::dmat4& worldToNdcRows, const std::string& file) {
  const auto contradicts = [&](const std::string& found, const std::string& expected) {
    throw MeaningError(fmt::format("{}: attribute worldToCamera: found {}, expected {}", file, found, expected));
  };
  if (!allFinite(worldToCameraRows) || !allFinite(worldToNdcRows))
    throw MeaningError(
        file + ": attributes worldToCamera and worldToNDC: found a number that is not finite, expected a camera");
  // A GLM column holds what EXR calls a row, so as read they are the column-vector form. pbrt stores the transpose:
  // then the translation stands where (0, 0, 0, 1) belongs.
  glm::dmat4 cameraFromWorld = worldToCameraRows, ndcFromWorld = worldToNdcRows;
  Camera camera;
  camera.origin = "attribute worldToCamera";
  if (!isAffine(cameraFromWorld)) {
    cameraFromWorld = glm::transpose(cameraFromWorld);
    ndcFromWorld = glm::transpose(ndcFromWorld);
    camera.origin += ", transposed";
    if (!isAffine(cameraFromWorld)) contradicts("a projection", "a rotation and a translation");
  }
  const glm::dmat3 rotation(cameraFromWorld);
  if (shear(rotation) > kOrthonormal) contradicts("scale or shear", "a rotation and a translation");
  if (glm::determinant(rotation) > 0)
    contradicts("no change of handedness", "left-handed camera space, +z forward, from a right-handed world");

  // What products of floats lose: a few units in the last place of the largest terms that cancel.
  const glm::dmat4 worldFromCamera = glm::inverse(cameraFromWorld);
  const double slack = 4.0 * 1.2e-7 * largest(ndcFromWorld) * std::max(1.0, largest(worldFromCamera));
  const Lens lens = lensOf(ndcFromWorld * worldFromCamera, std::max(slack, 1e-6), file);
  camera.viewFromWorld = kFlipZ * cameraFromWorld;
  camera.orthographic = lens.orthographic;
  camera.focal = {2.0 * lens.scale.x, 2.0 * std::abs(lens.scale.y)};
  camera.centre = {2.0 * lens.shift.x - 1.0, 1.0 - 2.0 * lens.shift.y};
  if (lens.scale.y > 0) {  // NDC that grows upwards, as pbrt's
    camera.centre.y = -camera.centre.y;
    camera.origin += ", y up";
  }
  return camera;
}

void cameraToExr(const Camera& camera, float worldToCamera[4][4], float worldToNdc[4][4]) {
  const glm::dmat4 cameraFromWorld = kFlipZ * camera.viewFromWorld;
  const glm::dvec2 scale(camera.focal.x * 0.5, -camera.focal.y * 0.5);
  const glm::dvec2 shift((camera.centre.x + 1.0) * 0.5, (1.0 - camera.centre.y) * 0.5);
  glm::dmat4 ndcFromCamera(0.0);
  ndcFromCamera[0][0] = scale.x;
  ndcFromCamera[1][1] = scale.y;
  ndcFromCamera[2][2] = 1.0;
  if (camera.orthographic) {
    ndcFromCamera[3] = {shift.x, shift.y, 0.0, 1.0};
  } else {
    ndcFromCamera[2] = {shift.x, shift.y, 1.0, 1.0};
    ndcFromCamera[3][2] = -1.0;  // any depth will do, so long as the matrix can be inverted
  }
  const glm::dmat4 ndcFromWorld = ndcFromCamera * cameraFromWorld;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      worldToCamera[row][column] = static_cast<float>(cameraFromWorld[row][column]);
      worldToNdc[row][column] = static_cast<float>(ndcFromWorld[row][column]);
    }
}

double focalPixels(const Camera& camera, const Window& display) {
  return camera.focal.x * display.width() * 0.5;
}

}  // namespace pellucid
