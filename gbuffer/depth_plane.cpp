#include "gbuffer/depth_plane.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kReach = kPlaneReach;
constexpr int kKnown = 2 * kReach;  // around a part: neighbours that tell a slope, and theirs
// Two pixels side by side that continue nothing are taken for one surface where what is linear changes by less.
constexpr double kPairChange = 1.0 / 16.0;
constexpr double kKink = 8.0;            // a bend so many times that of the next pixels is none of a curve
constexpr double kLevel = 1.0 / 16.0;    // a step so much lower than that to the other side
constexpr double kGrazing = 1.0 / 64.0;  // a normal this square to the ray tells no slope

// Along one axis through a pixel: what is linear on a plane, as a part of its value at the pixel.
struct Line {
  PlaneValues value;
  double rounding;  // of a second difference, by the precision of the depth
  double at(int k) const { return value[static_cast<std::size_t>(k + kReach)]; }
  double bend(int k) const { return std::abs(at(k + 1) - 2.0 * at(k) + at(k - 1)); }  // NaN where one is missing
  bool straight(int k) const { return bend(k) <= rounding * std::max({1.0, at(k), at(k - 1), at(k + 1)}); }
};

// How many pixels to one side lie on one straight line with the pixel; 1 where there is a neighbour at all.
int run(const Line& line, int side) {
  if (std::isnan(line.at(side))) return 0;
  int length = 1;
  while (length < kReach && line.straight(side * length)) ++length;
  return length;
}

// On planes, and on anything as flat as the depth's precision tells: the longest run, against rounding.
std::optional<double> straightSlope(const Line& line) {
  const int right = run(line, 1), left = run(line, -1);
  if (right > 0 && left > 0 && line.straight(0)) {
    const int both = std::min(right, left);
    const int r = both > 1 ? both : right, l = both > 1 ? both : left;
    return (line.at(r) - line.at(-l)) / (r + l);
  }
  if (right < 2 && left < 2) return std::nullopt;
  const int longer = right >= left ? right : -left;
  return (line.at(longer) - 1.0) / longer;
}

// On curved surfaces: where the slope changes by less than a quarter of itself across the pixel.
std::optional<double> curvedSlope(const Line& line) {
  const double steepest = std::max(std::abs(line.at(1) - 1.0), std::abs(line.at(-1) - 1.0));
  if (line.bend(0) <= 0.25 * steepest) return 0.5 * (line.at(1) - line.at(-1));
  return std::nullopt;
}

// At the end of a curved surface: where the slope changes by less than half to one side of the pixel.
std::optional<double> slopeToOneSide(const Line& line) {
  const double bends[2] = {line.bend(1), line.bend(-1)};
  const double least = std::fmin(bends[0], bends[1]);  // NaN where there is no side
  const int side = bends[0] == least ? 1 : -1;
  const double change = line.at(side) - 1.0;
  if (!(least <= 0.5 * std::abs(change))) return std::nullopt;
  // Curves bend little by little: what all but ends bending at the neighbour is a plane of its own.
  if (least > kKink * (line.bend(2 * side) + line.rounding)) return std::nullopt;
  // A neighbour to the other side beyond which there is nothing tells no bend, but may lie much more level. Where one
  // lies almost level, three surfaces may stand in a line by chance.
  const double level = std::isnan(bends[side == 1 ? 1 : 0]) ? 0.5 : kLevel;
  if (std::abs(line.at(-side) - 1.0) < level * std::abs(change)) return std::nullopt;
  return side * (change - 0.5 * (line.at(2 * side) - 2.0 * line.at(side) + 1.0));
}

// On things two pixels wide: the neighbour that belongs to no surface of its own.
double pairSlope(const Line& line) {
  double slope = 0.0, least = kPairChange;
  for (const int side : {-1, 1}) {
    const double change = line.at(side) - 1.0;
    if (line.straight(2 * side) || !(std::abs(change) < least)) continue;
    least = std::abs(change);
    slope = side * change;
  }
  return slope;
}

// A second difference holds four values, each rounded by half of the precision at most.
double roundingOf(double precision) {
  return 2.0 * precision;
}

std::optional<double> slopeThrough(const Line& line) {
  const std::optional<double> slope = straightSlope(line);
  return slope ? slope : curvedSlope(line);
}

// The slopes of planes by the normals of the file.
class NormalSlopes {
 public:
  NormalSlopes(const GBuffer& gbuffer, const Camera& camera)
      : normal_(gbuffer.normal), viewFromWorld_(camera.viewFromWorld), orthographic_(camera.orthographic) {
    const glm::dvec2 size(gbuffer.display.width(), gbuffer.display.height());
    step_ = glm::dvec2(2.0, -2.0) / size / camera.focal;
    const glm::dvec2 first(gbuffer.data.x0 - gbuffer.display.x0 + 0.5, gbuffer.data.y0 - gbuffer.display.y0 + 0.5);
    origin_ = (glm::dvec2(-1.0, 1.0) - camera.centre) / camera.focal + step_ * first;
  }
  // Change per pixel of what is linear, as a part of it; nothing without a normal that faces the eye.
  std::optional<glm::dvec2> at(int x, int y, double z) const {
    if (normal_.empty()) return std::nullopt;
    const glm::dvec3 normal = viewFromWorld_ * glm::dvec3(normal_.at(x, y));
    const double length = glm::length(normal);
    if (!(length > 0.5) || !std::isfinite(length)) return std::nullopt;
    const glm::dvec2 place = origin_ + step_ * glm::dvec2(x, y);
    const glm::dvec3 ray = orthographic_ ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(place, -1.0);
    const double facing = -glm::dot(normal, ray);
    if (facing < kGrazing * length * glm::length(ray)) return std::nullopt;
    const glm::dvec2 slope = glm::dvec2(normal) * step_ / -facing;
    return orthographic_ ? -slope / z : slope;
  }

 private:
  const Image<glm::vec3>& normal_;
  glm::dmat3 viewFromWorld_;
  bool orthographic_;
  glm::dvec2 origin_, step_;
};

// What is linear, of the pixels of a part and of all that tell their slopes; NaN where nothing was hit.
class LinearDepth {
 public:
  LinearDepth(const Image<float>& viewZ, bool orthographic, const Window& part)
      : known_{std::max(part.x0 - kKnown, 0), std::max(part.y0 - kKnown, 0), std::min(part.x1 + kKnown, viewZ.width()),
               std::min(part.y1 + kKnown, viewZ.height())},
        linear_(known_.width(), known_.height()) {
    tbb::parallel_for(known_.y0, known_.y1, [&](int y) {
      for (int x = known_.x0; x < known_.x1; ++x) {
        const auto z = static_cast<double>(viewZ.at(x, y));
        linear_.at(x - known_.x0, y - known_.y0) = !std::isfinite(z) ? kNone : orthographic ? z : 1.0 / z;
      }
    });
  }
  double at(int x, int y) const { return linear_.at(x - known_.x0, y - known_.y0); }
  // Through a pixel of the part, or within reach of one.
  Line through(int x, int y, int dx, int dy, double rounding) const {
    Line line{};
    line.rounding = rounding;
    const double scale = 1.0 / at(x, y);
    for (int k = -kReach; k <= kReach; ++k) {
      const int u = x + k * dx, v = y + k * dy;
      const bool inside = u >= known_.x0 && v >= known_.y0 && u < known_.x1 && v < known_.y1;
      line.value[static_cast<std::size_t>(k + kReach)] = inside ? at(u, v) * scale : kNone;
    }
    return line;
  }

 private:
  Window known_;
  Image<double> linear_;
};

// Where a pixel's own row does not tell its plane, the rows of those do that lie on one line with it across: the edge
// of a surface need not be that of the next row.
std::optional<double> slopeOfRowsBeside(const LinearDepth& linear, int x, int y, int axis, double rounding) {
  const int dx = 1 - axis, dy = axis;
  const Line across = linear.through(x, y, dy, dx, rounding);
  const int lengths[2] = {run(across, -1), run(across, 1)};
  for (int k = 1; k <= kReach; ++k)
    for (const int side : {-1, 1}) {
      const int length = lengths[side == 1 ? 1 : 0];
      if (k > length || (length < 2 && !across.straight(0))) continue;
      const auto slope = straightSlope(linear.through(x + side * k * dy, y + side * k * dx, dx, dy, rounding));
      if (slope) return *slope * across.at(side * k);
    }
  return std::nullopt;
}

}  // namespace

std::optional<double> slopeAlong(const PlaneValues& values, double precision) {
  const Line line{values, roundingOf(precision)};
  const std::optional<double> slope = slopeThrough(line);
  return slope ? slope : slopeToOneSide(line);
}

DepthPlanes::DepthPlanes(const GBuffer& gbuffer, const Camera& camera)
    : DepthPlanes(gbuffer, camera, {0, 0, gbuffer.viewZ.width(), gbuffer.viewZ.height()}) {}

DepthPlanes::DepthPlanes(const GBuffer& gbuffer, const Camera& camera, const Window& part)
    : gbuffer_(gbuffer),
      orthographic_(camera.orthographic),
      part_(part),
      slopes_(part.width(), part.height(), glm::vec2(0.0f)) {
  const LinearDepth linear(gbuffer.viewZ, orthographic_, part);
  const NormalSlopes normals(gbuffer, camera);
  const double rounding = roundingOf(static_cast<double>(gbuffer.depthPrecision));
  tbb::parallel_for(part.y0, part.y1, [&](int y) {
    for (int x = part.x0; x < part.x1; ++x) {
      if (std::isnan(linear.at(x, y))) continue;
      for (const int axis : {0, 1}) {
        const Line line = linear.through(x, y, 1 - axis, axis, rounding);
        std::optional<double> slope = slopeThrough(line);
        if (!slope) slope = slopeOfRowsBeside(linear, x, y, axis, rounding);
        if (!slope) slope = slopeToOneSide(line);
        if (!slope)
          if (const auto byNormal = normals.at(x, y, static_cast<double>(gbuffer.viewZ.at(x, y))))
            slope = (*byNormal)[axis];
        slopes_.at(x - part.x0, y - part.y0)[axis] = static_cast<float>(slope ? *slope : pairSlope(line));
      }
    }
  });
}

DepthPlane DepthPlanes::at(int x, int y) const {
  const glm::dvec2 slope(slopes_.at(x - part_.x0, y - part_.y0));
  return {static_cast<double>(gbuffer_.viewZ.at(x, y)), slope.x, slope.y, orthographic_};
}

void DepthPlanes::depthAt(glm::dvec2 sample, Image<float>& viewZ) const {
  depthAt(sample, {0, 0, viewZ.width(), viewZ.height()}, viewZ);
}

void DepthPlanes::depthAt(glm::dvec2 sample, const Window& part, Image<float>& viewZ) const {
  const glm::dvec2 offset = sample - 0.5;
  const auto precision = static_cast<double>(gbuffer_.depthPrecision);
  tbb::parallel_for(part.y0, part.y1, [&](int y) {
    for (int x = part.x0; x < part.x1; ++x) {
      const float centre = gbuffer_.viewZ.at(x, y);
      if (!std::isfinite(centre)) {
        viewZ.at(x, y) = centre;
        continue;
      }
      double z = at(x, y).z(offset.x, offset.y);
      // What the centre's depth was rounded by is a larger part of a nearer one; with perspective it stays the same
      // part.
      if (orthographic_) z += precision * std::max(static_cast<double>(centre) - z, 0.0);
      viewZ.at(x, y) = static_cast<float>(z);
    }
  });
}

}  // namespace pellucid
