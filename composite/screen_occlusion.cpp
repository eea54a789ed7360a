#include "composite/screen_occlusion.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "composite/nearest_pyramid.h"

namespace pellucid {
namespace {

constexpr int kSlices = 3;             // directions per pixel, both ways along each
constexpr int kSteps = 8;              // depths per way
constexpr double kStepPower = 1.5;     // spacing: nearer things hide more
constexpr int kTurns = 4;              // a 4x4 block of pixels turns and shifts them 16 ways
constexpr int kFilter = 2;             // the filter spans five pixels: each turn of the block once
constexpr double kBlock = 0.5;         // of a step: a tap sees the nearest pixel of a block so wide
constexpr double kFade = 0.2;          // of the radius: within it things begin to count, so that none appears at once
constexpr double kSameSurface = 0.02;  // of the depth: how far neighbours of one surface may differ per pixel
constexpr double kOwnPlane = 0.03;     // sine of the elevation up to which a tap is the surface itself
constexpr double kSameFit = 1e-5;      // of the depth

class Horizons {
 public:
  Horizons(const Image<float>& viewZ, const Camera& camera, const Window& display, const Window& data,
           const ScreenOcclusionSettings& settings)
      : viewZ_(viewZ), nearest_(viewZ), settings_(settings), orthographic_(camera.orthographic) {
    // NDC of a data pixel, then view space: x_view = (ndc - centre) / focal [* z].
    scale_ = {2.0 / (display.width() * camera.focal.x), -2.0 / (display.height() * camera.focal.y)};
    const glm::dvec2 first(data.x0 - display.x0 + 0.5, data.y0 - display.y0 + 0.5);
    offset_ = {(2.0 * first.x / display.width() - 1.0 - camera.centre.x) / camera.focal.x,
               (1.0 - 2.0 * first.y / display.height() - camera.centre.y) / camera.focal.y};
  }

  bool hit(int x, int y) const { return nearest_.hit(x, y); }

  // View space, y up, towards -z.
  glm::dvec3 point(int x, int y) const {
    const double z = static_cast<double>(viewZ_.at(x, y)), spread = orthographic_ ? 1.0 : z;
    return {(offset_.x + scale_.x * x) * spread, (offset_.y + scale_.y * y) * spread, -z};
  }

  // Of the pixel's surface, towards the eye: from the neighbours on whichever side it continues best.
  glm::dvec3 normal(int x, int y, const glm::dvec3& here) const {
    const glm::dvec3 across = slope(x, y, 1, 0, here), down = slope(x, y, 0, 1, here);
    const glm::dvec3 normal = glm::cross(down, across);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return toEye(here);
    const glm::dvec3 unit = normal / length;
    return glm::dot(unit, toEye(here)) < 0.0 ? -unit : unit;
  }

  glm::dvec3 toEye(const glm::dvec3& here) const {
    return orthographic_ ? glm::dvec3(0.0, 0.0, 1.0) : -glm::normalize(here);
  }

  // Cosine-weighted part of the hemisphere that nothing within the radius hides.
  double open(int x, int y) const {
    const glm::dvec3 here = point(x, y), eye = toEye(here), up = normal(x, y, here);
    const double z = -here.z, radius = settings_.radius > 0.0 ? settings_.radius : settings_.relativeRadius * z;
    const double pixel = std::abs(scale_.x) * (orthographic_ ? 1.0 : z);
    const double reach = std::min(radius / pixel, static_cast<double>(viewZ_.width() + viewZ_.height()));
    if (!(reach > 1.0)) return 1.0;
    const int column = x & (kTurns - 1), row = y & (kTurns - 1), turns = kTurns * kTurns;
    const int turn = (column * 5 + row * 12) % turns;
    const double jitter = ((column * kTurns + row) * 7 % turns + 0.5) / turns;
    const Taps taps = tapsWithin(reach, jitter);
    double sum = 0.0, weight = 0.0;
    for (int slice = 0; slice < kSlices; ++slice) {
      const double angle = glm::pi<double>() * (slice + (turn + 0.5) / turns) / kSlices;
      const glm::dvec2 along(std::cos(angle), std::sin(angle));
      // The slice's plane holds the eye and the direction on the screen (y down there, up here).
      glm::dvec3 tangent(along.x, -along.y, 0.0);
      tangent -= eye * glm::dot(eye, tangent);
      const double bent = glm::length(tangent);
      if (!(bent > 1e-6)) continue;
      tangent /= bent;
      const glm::dvec3 axis = glm::cross(tangent, eye);
      const glm::dvec3 flat = up - axis * glm::dot(up, axis);
      const double length = glm::length(flat);
      if (!(length > 1e-6)) continue;
      const double lean = std::atan2(glm::dot(flat, tangent), glm::dot(flat, eye));
      for (const double way : {-1.0, 1.0}) {
        // Angles from the eye towards `way`; nothing hides more than the surface's own plane.
        const double own = 0.5 * glm::pi<double>() + way * lean;
        const double horizon = std::min(highest(x, y, here, eye, up, along * way, taps, radius, std::cos(own)), own);
        sum += length * arc(way * horizon, lean);
        weight += length * arc(way * own, lean);
      }
    }
    return weight > 0.0 ? std::clamp(sum / weight, 0.0, 1.0) : 1.0;
  }

 private:
  // Cosine-weighted share of a half slice, up to the angle h.
  static double arc(double h, double lean) {
    return 0.25 * (-std::cos(2.0 * h - lean) + std::cos(lean) + 2.0 * h * std::sin(lean));
  }

  struct Tap {
    double distance;  // pixels
    int level;        // of the pyramid
  };
  using Taps = std::array<Tap, kSteps>;

  Taps tapsWithin(double reach, double jitter) const {
    Taps taps{};
    double from = 1.0;
    for (int step = 0; step < kSteps; ++step) {
      const double to = 1.0 + std::pow((step + 1.0) / kSteps, kStepPower) * std::max(reach - 1.0, 0.0);
      Tap& tap = taps[static_cast<std::size_t>(step)];
      tap.distance = from + jitter * (to - from);
      for (double block = kBlock * (to - from); block >= 2.0 && tap.level < nearest_.levels(); block *= 0.5)
        ++tap.level;
      from = to;
    }
    return taps;
  }

  glm::dvec3 slope(int x, int y, int dx, int dy, const glm::dvec3& here) const {
    const double before = misfit(x, y, -dx, -dy), after = misfit(x, y, dx, dy);
    // Both sides of a plane fit but for the last bits of float depth, which are no reason to change sides.
    if (before + kSameFit < after) return here - point(x - dx, y - dy);
    return std::isfinite(after) ? point(x + dx, y + dy) - here : glm::dvec3(0.0);
  }

  // How far, relative to its depth, the pixel lies from the surface that its next two neighbours one way span; on a
  // plane 1/z is linear in pixels. Of one neighbour alone, how far that one lies; infinite without any.
  double misfit(int x, int y, int dx, int dy) const {
    if (!hit(x + dx, y + dy)) return std::numeric_limits<double>::infinity();
    const auto inverse = [&](int k) {
      const double z = static_cast<double>(viewZ_.at(x + k * dx, y + k * dy));
      return orthographic_ ? z : 1.0 / z;
    };
    const double near1 = inverse(1), near2 = hit(x + 2 * dx, y + 2 * dy) ? inverse(2) : near1;
    return std::abs(1.0 - (2.0 * near1 - near2) / inverse(0));
  }

  // Angle from the eye's direction to the highest thing one way, radians.
  //   own  cosine of the angle to the surface's own plane: what nothing leaves
  double highest(int x, int y, const glm::dvec3& here, const glm::dvec3& eye, const glm::dvec3& up,
                 const glm::dvec2& way, const Taps& taps, double radius, double own) const {
    double most = own;
    int last = -1;
    for (const Tap& tap : taps) {
      const int found = nearest_.at(static_cast<int>(std::floor(x + 0.5 + way.x * tap.distance)),
                                    static_cast<int>(std::floor(y + 0.5 + way.y * tap.distance)), tap.level);
      if (found < 0 || found == last) continue;
      last = found;
      const glm::dvec3 path = point(found % viewZ_.width(), found / viewZ_.width()) - here;
      const double length = glm::length(path);
      if (!(length > 0.0) || length >= radius) continue;
      // Taps fall on pixels beside the slice: what lies in the surface's own plane hides nothing.
      if (glm::dot(path, up) <= kOwnPlane * length) continue;
      const double fade = std::min((1.0 - length / radius) / kFade, 1.0);
      most = std::max(most, glm::mix(own, glm::dot(path, eye) / length, fade));
    }
    return std::acos(std::clamp(most, -1.0, 1.0));
  }

  const Image<float>& viewZ_;
  NearestPyramid nearest_;
  ScreenOcclusionSettings settings_;
  bool orthographic_;
  glm::dvec2 scale_, offset_;
};

Image<std::uint8_t> dilated(const Image<std::uint8_t>& wanted) {
  const int width = wanted.width(), height = wanted.height();
  Image<std::uint8_t> rows(width, height), all(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (wanted.at(x, y))
        for (int k = std::max(x - kFilter, 0); k <= std::min(x + kFilter, width - 1); ++k) rows.at(k, y) = 1;
  for (int y = 0; y < height; ++y)
    for (int k = std::max(y - kFilter, 0); k <= std::min(y + kFilter, height - 1); ++k)
      for (int x = 0; x < width; ++x) all.at(x, y) |= rows.at(x, k);
  return all;
}

template <class Row>
void forRows(int height, Row row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

}  // namespace

Image<float> screenOcclusion(const Image<float>& viewZ, const Camera& camera, const Window& display, const Window& data,
                             const ScreenOcclusionSettings& settings, const Image<std::uint8_t>* wanted) {
  const int width = viewZ.width(), height = viewZ.height();
  const Horizons horizons(viewZ, camera, display, data, settings);
  Image<std::uint8_t> computed = wanted ? dilated(*wanted) : Image<std::uint8_t>(width, height, 1);
  Image<float> rough(width, height, 1.0f), smooth(width, height, 1.0f);
  forRows(height, [&](int y) {
    for (int x = 0; x < width; ++x)
      if (computed.at(x, y) && horizons.hit(x, y)) rough.at(x, y) = static_cast<float>(horizons.open(x, y));
  });
  forRows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if ((wanted && !wanted->at(x, y)) || !horizons.hit(x, y)) continue;
      const double z = static_cast<double>(viewZ.at(x, y));
      double sum = 0.0, weight = 0.0;
      for (int dy = -kFilter; dy <= kFilter; ++dy)
        for (int dx = -kFilter; dx <= kFilter; ++dx) {
          if (!horizons.hit(x + dx, y + dy)) continue;
          const double apart = std::abs(static_cast<double>(viewZ.at(x + dx, y + dy)) - z);
          // The outermost of five pixels repeat a turn of the block: each counts half.
          const double share = (std::abs(dx) == kFilter ? 0.5 : 1.0) * (std::abs(dy) == kFilter ? 0.5 : 1.0);
          const double alike = share * std::max(0.0, 1.0 - apart / (kSameSurface * z));
          sum += alike * static_cast<double>(rough.at(x + dx, y + dy));
          weight += alike;
        }
      smooth.at(x, y) = static_cast<float>(sum / weight);
    }
  });
  return smooth;
}

}  // namespace pellucid
