#include "composite/surface_sides.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

// Two pixels lie on different surfaces where each is farther from the other's plane than this, relative to its depth.
constexpr double kApart = 1.0 / 256.0;
// A plane whose slope is told by more than one neighbour changes by more from pixel to pixel, relative...
constexpr double kSteep = 1.0 / 16.0;
// ...and misses a surface by more, relative, where it is not that surface's.
constexpr double kMissed = 1.0 / 16.0;
// How much more the slope of a ball may change at its limb than a pixel before: by as much where the limb passes
// through the pixel's centre.
constexpr double kLimb = 6.1;
// How much more a surface may bend at a step than a step before, seen from either end, whichever way it slopes: along
// the diagonals of a ball it falls and rises again.
constexpr double kOn = 2.0;
// A step no higher than so many times those before and after it, in their direction, is the slope of one surface...
constexpr double kAlike = 2.0;
// ...unless what lies before does not bend by at least this part of what the step does: a plane ends there...
constexpr double kBent = 0.25;
// ...and where one of those is so many times as high as it, the surface ends there, and the other tells alone.
constexpr double kEnds = 4.0;
constexpr double kFarthest = 1e30;  // stands for nothing at all
// Steps tell what touches an edge, planes tell steps: around a part each is needed somewhat farther.
constexpr int kStepsAround = kTouchAround + 2;
static_assert(kStepsAround + 4 <= kSidesAround);
constexpr int kSteps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};

bool isSteep(const DepthPlane& plane, int dx, int dy) {
  return std::abs(plane.across * dx + plane.down * dy) > kSteep;
}

}  // namespace

SurfaceSides::SurfaceSides(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part)
    : gbuffer_(gbuffer), planes_(planes), part_(part), width_(gbuffer.viewZ.width()), height_(gbuffer.viewZ.height()) {
  markSteps();
  markTouching();
}

// The part, as far as the picture goes.
Window SurfaceSides::around(int reach) const {
  return {std::max(part_.x0 - reach, 0), std::max(part_.y0 - reach, 0), std::min(part_.x1 + reach, width_),
          std::min(part_.y1 + reach, height_)};
}

bool SurfaceSides::Bends::steepens() const {
  const double one = std::abs(first), two = std::abs(second), three = std::abs(third);
  return told && first * second >= 0.0 && second * third > 0.0 && one <= two && two <= three &&
         three <= two + kLimb * (two - one);
}

bool SurfaceSides::Bends::goesOn() const {
  const double bend = second - first, next = third - second;
  return told && bend * next > 0.0 && std::abs(next) <= kOn * std::abs(bend);
}

bool SurfaceSides::Bends::isAlike() const {
  const double before = std::abs(second), step = std::abs(third);
  if (!(second * third > 0.0 && step <= kAlike * before && before <= kEnds * step)) return false;
  const bool alone = std::abs(first) > kEnds * std::abs(second);
  return alone || std::abs(second - first) >= kBent * std::abs(third - second);
}

bool SurfaceSides::Bends::begins() const {
  return std::abs(second) > kEnds * std::max(std::abs(first), std::abs(third));
}

// Of a step seen from either end.
bool SurfaceSides::areOne(const Bends& from, const Bends& back) {
  const bool alike = from.isAlike(), backAlike = back.isAlike();
  if ((alike || backAlike) && (alike || from.begins()) && (backAlike || back.begins())) return true;
  // Four pixels between two other surfaces, which bend to one side throughout, as over the top of a ball.
  const double highest = std::max({std::abs(from.second), std::abs(from.third), std::abs(back.second)});
  if (!(std::min(std::abs(from.first), std::abs(back.first)) > kEnds * highest)) return false;
  const double bend = from.third - from.second, next = back.third - back.second;  // backwards steps are negative
  return bend * next > 0.0 && std::abs(next) <= kEnds * std::abs(bend) && std::abs(bend) <= kEnds * std::abs(next);
}

// Whether either pixel, both of which were hit, lies on the other's plane, or as deep.
bool SurfaceSides::onPlanes(int x, int y, int u, int v) const {
  const auto z = static_cast<double>(gbuffer_.viewZ.at(x, y)), other = static_cast<double>(gbuffer_.viewZ.at(u, v));
  const double least = kApart * std::min(z, other);
  const DepthPlane own = planes_.at(x, y), beside = planes_.at(u, v);
  const bool ownIsSteep = isSteep(own, u - x, v - y), besideIsSteep = isSteep(beside, u - x, v - y);
  if (std::abs(z - other) <= least && !ownIsSteep && !besideIsSteep) return true;
  const double ownOff = std::abs(own.z(u - x, v - y) - other), besideOff = std::abs(beside.z(x - u, y - v) - z);
  // A pixel in whose middle surfaces meet lies on the plane of either.
  if ((ownIsSteep && ownOff > kMissed * other) || (besideIsSteep && besideOff > kMissed * z)) return false;
  return std::min({std::abs(z - other), ownOff, besideOff}) <= least;
}

bool SurfaceSides::apart(int x, int y, int u, int v) const {
  const bool here = hit(x, y), there = hit(u, v);
  if (!here || !there) return here != there;
  if (onPlanes(x, y, u, v)) return false;
  if (std::max(std::abs(u - x), std::abs(v - y)) > 1) return true;
  const int dx = u - x, dy = v - y;
  const std::optional<Bends> from = bendsOf(x, y, dx, dy), back = bendsOf(u, v, -dx, -dy);
  if ((from && from->steepens()) || (back && back->steepens())) return false;
  if (from && back && areOne(*from, *back)) return false;
  // Where the picture ends before two pixels, the other end tells alone.
  const bool begun = !inside(x - 2 * dx, y - 2 * dy), ended = !inside(u + 2 * dx, v + 2 * dy);
  if (begun && ended) return true;
  if (!begun && !ended) return !from->goesOn() || !back->goesOn();
  const Bends& end = begun ? *back : *from;
  if (const std::optional<Bends>& border = begun ? from : back) return !goesOnToBorder(end, *border);
  const auto z = static_cast<double>(gbuffer_.viewZ.at(x, y)), other = static_cast<double>(gbuffer_.viewZ.at(u, v));
  return !end.goesOn() || std::abs(z - other) > kMissed * std::min(z, other);
}

// Of a step of which one end tells; of the other there is one pixel more.
bool SurfaceSides::goesOnToBorder(const Bends& end, const Bends& border) {
  if (!end.goesOn()) return false;
  const double bend = end.third - end.second, next = border.third - border.second;
  return bend * next > 0.0 && std::abs(next) <= kOn * std::abs(bend);
}

// Of the step from a pixel to a neighbour, both of which were hit, and the two before it. Nothing where the picture
// ends at the pixel.
std::optional<SurfaceSides::Bends> SurfaceSides::bendsOf(int x, int y, int dx, int dy) const {
  if (!inside(x - dx, y - dy)) return std::nullopt;
  double at[4];
  bool told = true;
  for (int k = 0; k < 4; ++k) {
    const int u = x + (k - 2) * dx, v = y + (k - 2) * dy;
    const bool met = inside(u, v) && hit(u, v), orthographic = planes_.at(x, y).orthographic;
    const double z = met ? static_cast<double>(gbuffer_.viewZ.at(u, v)) : kFarthest;
    at[k] = orthographic ? z : 1.0 / z;  // linear on planes, which never bend so
    told = told && met;
  }
  const double first = inside(x - 2 * dx, y - 2 * dy) ? at[1] - at[0] : std::numeric_limits<double>::infinity();
  return Bends{first, at[2] - at[1], at[3] - at[2], told};
}

void SurfaceSides::markSteps() {
  steps_ = Image<std::uint8_t>(width_, height_, 0);
  const Window asked = around(kStepsAround);
  tbb::parallel_for(asked.y0, asked.y1, [&](int y) {
    for (int x = asked.x0; x < asked.x1; ++x)
      for (int k = 0; k < 4; ++k) {
        const int u = x + kSteps[k][0], v = y + kSteps[k][1];
        if (inside(u, v) && apart(x, y, u, v)) steps_.at(x, y) |= static_cast<std::uint8_t>(1 << k);
      }
  });
}

// Of two pixels side by side.
bool SurfaceSides::breaksBetween(int x, int y, int u, int v) const {
  if (v < y || (v == y && u < x)) return breaksBetween(u, v, x, y);
  const int k = v == y ? 0 : 2 + u - x;
  return steps_.at(x, y) >> k & 1;
}

void SurfaceSides::markTouching() {
  touchesEdge_ = Image<std::uint8_t>(width_, height_, 0);
  const Window asked = around(kTouchAround);
  tbb::parallel_for(asked.y0, asked.y1, [&](int y) {
    for (int x = asked.x0; x < asked.x1; ++x)
      for (int v = y - 1; v <= y + 1 && !touchesEdge_.at(x, y); ++v)
        for (int u = x - 1; u <= x + 1; ++u)
          if (inside(u, v) && (u != x || v != y) && breaksBetween(x, y, u, v)) touchesEdge_.at(x, y) = 1;
  });
}

// Whether the surface goes on from pixel to pixel along the line between two: where it bends, as towards the limb of a
// ball, planes say nothing of pixels farther off.
bool SurfaceSides::joined(int x, int y, int u, int v) const {
  const int steps = std::max(std::abs(u - x), std::abs(v - y));
  int fromX = x, fromY = y;
  for (int i = 1; i <= steps; ++i) {
    const int toX = x + (2 * (u - x) * i + (u < x ? -steps : steps)) / (2 * steps);
    const int toY = y + (2 * (v - y) * i + (v < y ? -steps : steps)) / (2 * steps);
    if (breaksBetween(fromX, fromY, toX, toY)) return false;
    fromX = toX;
    fromY = toY;
  }
  return true;
}

Side SurfaceSides::sideOf(int x, int y, int u, int v) const {
  if ((u == x && v == y) || !apart(x, y, u, v) || joined(x, y, u, v)) return Side::own;
  if (!hit(x, y)) return Side::nearer;
  if (!hit(u, v)) return Side::farther;
  return static_cast<double>(gbuffer_.viewZ.at(u, v)) < planes_.at(x, y).z(u - x, v - y) ? Side::nearer : Side::farther;
}

}  // namespace pellucid
