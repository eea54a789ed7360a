#include "gbuffer/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <optional>

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
  glm::dvec2 scale{}, shift{};  // ndc = scale * (x, y) / z + shift
  double divisor = 0;           // of the projection: 1 or -1 in what renderers write
  double leaning = 0;           // of depth: what x and y add to it, over the divisor
};

// What float matrices lose of a row of their product: of its first three numbers, and of the fourth, where the camera's
// place cancels, which may be large.
struct Slack {
  double turn = 0, place = 0;
};

Slack slackOf(const glm::dmat4& ndcFromWorld, int row, const glm::dmat4& worldFromCamera) {
  constexpr double kUnits = 4.0 * 1.2e-7;  // a few units in the last place of the largest terms that cancel
  constexpr double kTurns = 1e-5;          // of chains of rotations in floats
  const glm::dvec4 terms = glm::abs(glm::row(ndcFromWorld, row));
  const double turn = std::max({terms.x, terms.y, terms.z});
  const double place = std::max(terms.w, turn * std::max(1.0, glm::length(glm::dvec3(worldFromCamera[3]))));
  return {std::max(kTurns * turn, 1e-6), std::max({kTurns * turn, kUnits * place, 1e-6})};
}

// ndcFromWorld * worldFromCamera must be one of
//   perspective   (sx 0 cx 0) (0 sy cy 0) (any) (0 0 w 0)
//   orthographic  (sx 0 0 cx) (0 sy 0 cy) (any) (0 0 0 w)
// up to what float matrices lose. Else `found` says what it is instead.
std::optional<Lens> lensOf(const glm::dmat4& ndcFromWorld, const glm::dmat4& worldFromCamera, std::string& found) {
  const glm::dmat4 ndcFromCamera = ndcFromWorld * worldFromCamera;
  const glm::dvec4 x = glm::row(ndcFromCamera, 0), y = glm::row(ndcFromCamera, 1), w = glm::row(ndcFromCamera, 3);
  const Slack ofX = slackOf(ndcFromWorld, 0, worldFromCamera), ofY = slackOf(ndcFromWorld, 1, worldFromCamera),
              ofW = slackOf(ndcFromWorld, 3, worldFromCamera);
  Lens lens;
  lens.orthographic = std::abs(w.z) <= ofW.turn;
  lens.divisor = lens.orthographic ? w.w : w.z;
  bool along =
      std::max(std::abs(w.x), std::abs(w.y)) <= ofW.turn && std::abs(x.y) <= ofX.turn && std::abs(y.x) <= ofY.turn;
  if (lens.orthographic)
    along = along && std::abs(x.z) <= ofX.turn && std::abs(y.z) <= ofY.turn;
  else
    along = along && std::abs(w.w) <= ofW.place && std::abs(x.w) <= ofX.place && std::abs(y.w) <= ofY.place;
  if (!(std::abs(lens.divisor) > (lens.orthographic ? ofW.place : ofW.turn))) {
    found = "no projection";
  } else if (!along) {
    found = "a projection that is not along worldToCamera's z axis";
  } else {
    lens.scale = glm::dvec2(x.x, y.y) / lens.divisor;
    lens.leaning = glm::length(glm::dvec2(glm::row(ndcFromCamera, 2))) / std::abs(lens.divisor);
    lens.shift = glm::dvec2(lens.orthographic ? x.w : x.z, lens.orthographic ? y.w : y.z) / lens.divisor;
    // Seen along -z, x over z changes its sign; the caller has turned such spaces round.
    if (lens.divisor < 0 && !lens.orthographic)
      found = "a projection that looks down -z";
    else if (!(lens.scale.x > 0))
      found = "a mirrored picture";
    else if (lens.scale.y == 0)
      found = "a picture without height";
    else
      return lens;
  }
  return std::nullopt;
}

// One way to read the two attributes.
struct Reading {
  glm::dmat4 cameraFromWorld{1.0};  // left-handed camera space, +z forward
  Lens lens;
  bool transposed = false, rightHanded = false;
};

// Nothing when the attributes, read that way, are no camera; `found` says what they are then.
std::optional<Reading> readAs(const glm::dmat4& worldToCamera, const glm::dmat4& worldToNdc, bool transposed,
                              std::string& found) {
  Reading reading;
  reading.transposed = transposed;
  reading.cameraFromWorld = transposed ? glm::transpose(worldToCamera) : worldToCamera;
  const glm::dmat4 ndcFromWorld = transposed ? glm::transpose(worldToNdc) : worldToNdc;
  if (!isAffine(reading.cameraFromWorld)) {
    found = "a projection";
    return std::nullopt;
  }
  const glm::dmat3 rotation(reading.cameraFromWorld);
  if (shear(rotation) > kOrthonormal) {
    found = "scale or shear";
    return std::nullopt;
  }
  reading.rightHanded = glm::determinant(rotation) > 0;
  if (reading.rightHanded) reading.cameraFromWorld = kFlipZ * reading.cameraFromWorld;
  const glm::dmat4 worldFromCamera = glm::inverse(reading.cameraFromWorld);
  const std::optional<Lens> lens = lensOf(ndcFromWorld, worldFromCamera, found);
  if (!lens) return std::nullopt;
  reading.lens = *lens;
  return reading;
}

// NDC runs from 0 to 1 by EXR's rule, and from -1 to 1 in some files. The principal point tells: there it lies near
// (0, 0), which by EXR's rule is a corner of the picture.
bool isWide(const Lens& lens) {
  constexpr double kNearMiddle = 0.25;  // of the half picture
  return std::max(std::abs(lens.shift.x), std::abs(lens.shift.y)) <= kNearMiddle;
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
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw MeaningError(
        fmt::format("{}: attributes worldToCamera and worldToNDC: found {}, expected {}", file, found, expected));
  };
  if (!allFinite(worldToCameraRows) || !allFinite(worldToNdcRows)) refuse("a number that is not finite", "a camera");
  // A GLM column holds what EXR calls a row, so as read they are the column-vector form. pbrt stores the transpose,
  // which near the origin looks like a camera too. Transposing puts the principal point where depth is made, so the
  // better one has depth that x and y do not change, and then a projection that divides by z itself.
  std::string found[2];
  std::optional<Reading> best;
  for (const bool transposed : {false, true}) {
    const auto reading = readAs(worldToCameraRows, worldToNdcRows, transposed, found[transposed]);
    const auto off = [](const Reading& one) { return std::abs(std::abs(one.lens.divisor) - 1.0); };
    const auto better = [&](const Reading& one, const Reading& other) {
      const double apart = one.lens.leaning - other.lens.leaning;
      return std::abs(apart) > 1e-6 ? apart < 0 : off(one) < off(other) - 1e-6;
    };
    if (reading && (!best || better(*reading, *best))) best = reading;
  }
  if (!best)
    refuse(found[0] == "a projection" ? found[1] : found[0], "a rotation, a translation and a projection along z");
  const bool wide = isWide(best->lens);
  Camera camera;
  camera.origin = "attribute worldToCamera";
  if (best->transposed) camera.origin += ", transposed";
  if (best->rightHanded) camera.origin += ", right-handed";
  if (wide) camera.origin += ", NDC from -1 to 1";
  camera.viewFromWorld = kFlipZ * best->cameraFromWorld;
  camera.orthographic = best->lens.orthographic;
  const double toWide = wide ? 1.0 : 2.0;
  const glm::dvec2 centre = toWide * best->lens.shift - (wide ? 0.0 : 1.0);
  camera.focal = {toWide * best->lens.scale.x, toWide * std::abs(best->lens.scale.y)};
  camera.centre = {centre.x, -centre.y};
  if (best->lens.scale.y > 0) {  // NDC that grows upwards, as pbrt's
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
