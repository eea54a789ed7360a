#include "composite/edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "gbuffer/finite_colour.h"

namespace pellucid {
namespace {

// Two pixels lie on different surfaces where each is farther from the other's plane than this, relative to its depth.
constexpr double kApart = 1.0 / 256.0;
// How much more the slope of a ball may change at its limb than a pixel before: by as much where the limb passes
// through the pixel's centre.
constexpr double kLimb = 6.1;
// How much more a surface may bend at a step than a step before, seen from either end, whichever way it slopes: along
// the diagonals of a ball it falls and rises again.
constexpr double kOn = 2.0;
constexpr int kReach = 3;  // pixels in which unmixed neighbours are looked for
// Surfaces whose colours differ by less, relative to the brighter, do not tell their shares.
constexpr double kContrast = 1.0 / 16.0;
// How far a mixture may lie from the line between the two colours, as a part of its length.
constexpr double kOffLine = 0.25;
constexpr double kBetter = 0.8;         // continued colours must lie so much nearer to the line
constexpr double kWhole = 1.0 / 64.0;   // alpha within it of 1 or 0 is that of a whole surface, or of nothing
constexpr double kLeastOwn = 0.25;      // of a pixel whose neighbours lie mostly on its own surface
constexpr double kPure = 1.0 / 4096.0;  // less of a surface is none
// How far around an edge pixel its neighbours' edges, the steps that tell these and the planes that tell those are
// read: colours lie within kReach and are continued from less than twice as far.
constexpr int kBesideAround = 8, kStepsAround = 10;
static_assert(kStepsAround + 4 <= kEdgeSurroundings);

enum class Side : std::uint8_t { own, nearer, farther };

// The plane of the pixel at `offset` from another one, about that other one.
DepthPlane moved(const DepthPlane& plane, glm::dvec2 offset) {
  if (!std::isfinite(plane.centre)) return plane;
  const double linear = 1.0 + plane.across * -offset.x + plane.down * -offset.y;
  if (!(linear > 0.0)) return {plane.centre, 0.0, 0.0, plane.orthographic};
  return {plane.orthographic ? plane.centre * linear : plane.centre / linear, plane.across / linear,
          plane.down / linear, plane.orthographic};
}

class Finder {
 public:
  Finder(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part)
      : gbuffer_(gbuffer),
        planes_(planes),
        part_(part),
        width_(gbuffer.viewZ.width()),
        height_(gbuffer.viewZ.height()) {}
  std::vector<EdgePixel> find();

 private:
  // That of the nearest pixels that no edge touches, and the same continued to the pixel by its gradient.
  struct SideColour {
    glm::dvec4 nearest, continued;
  };
  struct Colours {
    SideColour nearer, farther;
  };
  struct Mixture {
    glm::dvec4 nearer, farther;
    double share;  // of the nearer, [0,1]
    double off;    // how far the pixel's colour lies from it, as a part of the line's length
  };
  struct Beside {
    Side other = Side::own;  // own: none of the neighbours lies there
    bool mostlyOwn = false;  // of the 3 x 3 pixels more lie on the pixel's side of the edge
  };
  // Three steps in a row.
  struct Bends {
    double first, second, third;
    // More and more steeply, as towards a ball's limb.
    bool steepens() const {
      const bool steeper = first * second >= 0.0 && second * third > 0.0 && std::abs(first) <= std::abs(second);
      return steeper && std::abs(third) <= std::abs(second) + kLimb * std::abs(second - first);
    }
    // Bent at the third as at the second, whichever way they slope.
    bool goesOn() const {
      const double bend = second - first, next = third - second;
      return bend * next > 0.0 && std::abs(next) <= kOn * std::abs(bend);
    }
  };
  Window around(int reach) const {  // the part, as far as the picture goes
    return {std::max(part_.x0 - reach, 0), std::max(part_.y0 - reach, 0), std::min(part_.x1 + reach, width_),
            std::min(part_.y1 + reach, height_)};
  }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  bool hit(int x, int y) const { return std::isfinite(gbuffer_.viewZ.at(x, y)); }
  bool apart(int x, int y, int u, int v) const;
  std::optional<Bends> bendsOf(int x, int y, int dx, int dy) const;
  void markSteps();
  void markBesideEdges();
  bool breaksBetween(int x, int y, int u, int v) const;
  bool joined(int x, int y, int u, int v) const;
  Side sideOf(int x, int y, int u, int v) const;
  std::array<Beside, 2> besideOf(int x, int y) const;
  glm::dvec2 directionOf(int x, int y, Side other) const;
  std::optional<SideColour> unmixed(int x, int y, Side side) const;
  glm::dvec4 continued(int x, int y, Side side, const glm::dvec4& colour, glm::dvec2 offset) const;
  std::optional<glm::dvec4> extreme(int x, int y, Side side, const glm::dvec4& opposite) const;
  static void readAlpha(double alpha, Mixture& mixture);
  static std::optional<Mixture> mixtureOf(const glm::dvec4& colour, const Colours& colours);
  std::optional<Colours> coloursOf(int x, int y, Side other) const;
  std::optional<DepthPlane> planeOf(int x, int y, Side other) const;
  std::optional<EdgePixel> edgeAt(int x, int y) const;
  std::optional<EdgePixel> edgeBeside(int x, int y, Side other, bool mostlyOwn) const;

  const GBuffer& gbuffer_;
  const DepthPlanes& planes_;
  Window part_;
  int width_, height_;
  Image<std::uint8_t> steps_;  // by bit, as kSteps: from the pixel to that neighbour the surface breaks off
  Image<std::uint8_t> besideEdge_;
};

constexpr int kSteps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};

bool Finder::apart(int x, int y, int u, int v) const {
  const bool here = hit(x, y), there = hit(u, v);
  if (!here || !there) return here != there;
  const auto z = static_cast<double>(gbuffer_.viewZ.at(x, y)), other = static_cast<double>(gbuffer_.viewZ.at(u, v));
  const double least = kApart * std::min(z, other);
  if (std::abs(z - other) <= least) return false;
  if (std::abs(planes_.at(x, y).z(u - x, v - y) - other) <= least ||
      std::abs(planes_.at(u, v).z(x - u, y - v) - z) <= least)
    return false;
  if (std::max(std::abs(u - x), std::abs(v - y)) > 1) return true;
  const int dx = u - x, dy = v - y;
  const std::optional<Bends> from = bendsOf(x, y, dx, dy), back = bendsOf(u, v, -dx, -dy);
  if ((from && from->steepens()) || (back && back->steepens())) return false;
  return !(from && back && from->goesOn() && back->goesOn());
}

// Of the step from a pixel to a neighbour and the two before it. Nothing where something was not hit.
std::optional<Finder::Bends> Finder::bendsOf(int x, int y, int dx, int dy) const {
  double at[4];
  for (int k = 0; k < 4; ++k) {
    const int u = x + (k - 2) * dx, v = y + (k - 2) * dy;
    if (!inside(u, v) || !hit(u, v)) return std::nullopt;
    const auto z = static_cast<double>(gbuffer_.viewZ.at(u, v));
    at[k] = planes_.at(u, v).orthographic ? z : 1.0 / z;  // linear on planes, which never bend so
  }
  return Bends{at[1] - at[0], at[2] - at[1], at[3] - at[2]};
}

void Finder::markSteps() {
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
bool Finder::breaksBetween(int x, int y, int u, int v) const {
  if (v < y || (v == y && u < x)) return breaksBetween(u, v, x, y);
  const int k = v == y ? 0 : 2 + u - x;
  return steps_.at(x, y) >> k & 1;
}

void Finder::markBesideEdges() {
  besideEdge_ = Image<std::uint8_t>(width_, height_, 0);
  const Window asked = around(kBesideAround);
  tbb::parallel_for(asked.y0, asked.y1, [&](int y) {
    for (int x = asked.x0; x < asked.x1; ++x)
      for (int v = y - 1; v <= y + 1 && !besideEdge_.at(x, y); ++v)
        for (int u = x - 1; u <= x + 1; ++u)
          if (inside(u, v) && (u != x || v != y) && breaksBetween(x, y, u, v)) besideEdge_.at(x, y) = 1;
  });
}

// Whether the surface goes on from pixel to pixel along the line between two: where it bends, as towards the limb of a
// ball, planes say nothing of pixels farther off.
bool Finder::joined(int x, int y, int u, int v) const {
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

// On which side of pixel (x, y)'s surface another pixel lies.
Side Finder::sideOf(int x, int y, int u, int v) const {
  if ((u == x && v == y) || !apart(x, y, u, v) || joined(x, y, u, v)) return Side::own;
  if (!hit(x, y)) return Side::nearer;
  if (!hit(u, v)) return Side::farther;
  return static_cast<double>(gbuffer_.viewZ.at(u, v)) < planes_.at(x, y).z(u - x, v - y) ? Side::nearer : Side::farther;
}

// First the side on which more of the eight neighbours lie, those that share an edge with the pixel counting twice.
std::array<Finder::Beside, 2> Finder::besideOf(int x, int y) const {
  int weight[3] = {0, 0, 0}, count[3] = {0, 0, 0};
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!inside(u, v)) continue;
      const auto side = static_cast<std::size_t>(sideOf(x, y, u, v));
      weight[side] += u == x || v == y ? 2 : 1;
      ++count[side];
    }
  const auto besideAt = [&](Side side) {
    const auto other = static_cast<std::size_t>(side);
    return weight[other] == 0 ? Beside() : Beside{side, 2 * count[other] < count[0] + count[1] + count[2]};
  };
  const Beside nearer = besideAt(Side::nearer), farther = besideAt(Side::farther);
  const bool nearerFirst =
      weight[static_cast<std::size_t>(Side::nearer)] >= weight[static_cast<std::size_t>(Side::farther)];
  return nearerFirst ? std::array<Beside, 2>{nearer, farther} : std::array<Beside, 2>{farther, nearer};
}

// Across the edge towards the nearer surface: the moment of what lies on it in 5 x 5 pixels.
glm::dvec2 Finder::directionOf(int x, int y, Side other) const {
  glm::dvec2 moment(0.0);
  for (int v = y - 2; v <= y + 2; ++v)
    for (int u = x - 2; u <= x + 2; ++u) {
      if (!inside(u, v)) continue;
      const Side side = sideOf(x, y, u, v);
      const bool isNearer = side == Side::nearer || (other == Side::farther && side == Side::own);
      moment += (isNearer ? 1.0 : -1.0) * glm::dvec2(u - x, v - y);
    }
  const double length = glm::length(moment);
  return length > 0.0 ? moment / length : glm::dvec2(1.0, 0.0);
}

// The mean of the nearest pixels on a side that no edge touches.
std::optional<Finder::SideColour> Finder::unmixed(int x, int y, Side side) const {
  glm::dvec4 sum(0.0);
  glm::dvec2 offset(0.0);
  int count = 0, nearest = std::numeric_limits<int>::max();
  for (int v = y - kReach; v <= y + kReach; ++v)
    for (int u = x - kReach; u <= x + kReach; ++u) {
      const int squared = (u - x) * (u - x) + (v - y) * (v - y);
      if (squared > nearest || !inside(u, v) || besideEdge_.at(u, v) || sideOf(x, y, u, v) != side) continue;
      const glm::vec4& colour = gbuffer_.beauty.at(u, v);
      if (!isFinite(colour)) continue;
      if (squared < nearest) {
        sum = glm::dvec4(0.0);
        offset = glm::dvec2(0.0);
        count = 0;
        nearest = squared;
      }
      sum += glm::dvec4(colour);
      offset += glm::dvec2(u - x, v - y);
      ++count;
    }
  if (count == 0) return std::nullopt;
  const glm::dvec4 mean = sum / static_cast<double>(count);
  return SideColour{mean, continued(x, y, side, mean, offset / static_cast<double>(count))};
}

// The colour at the pixel, on the straight line through one at `offset` and one farther from the edge.
glm::dvec4 Finder::continued(int x, int y, Side side, const glm::dvec4& colour, glm::dvec2 offset) const {
  const double distance = glm::length(offset);
  if (!(distance > 0.5)) return colour;
  const glm::dvec2 next = offset * ((distance + 1.5) / distance);
  const int u = x + static_cast<int>(std::lround(next.x)), v = y + static_cast<int>(std::lround(next.y));
  if (!inside(u, v) || besideEdge_.at(u, v) || sideOf(x, y, u, v) != side) return colour;
  const double farther = glm::length(glm::dvec2(u - x, v - y));
  if (!(farther > distance + 0.5) || !isFinite(gbuffer_.beauty.at(u, v))) return colour;
  const glm::dvec4 change = (colour - glm::dvec4(gbuffer_.beauty.at(u, v))) / (farther - distance);
  return glm::max(colour + change * distance, glm::dvec4(0.0));
}

// Of things so narrow that an edge touches every pixel of theirs: the one least like the other side.
std::optional<glm::dvec4> Finder::extreme(int x, int y, Side side, const glm::dvec4& opposite) const {
  std::optional<glm::dvec4> found;
  double farthest = 0.0;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!inside(u, v) || sideOf(x, y, u, v) != side) continue;
      const glm::dvec4 colour(gbuffer_.beauty.at(u, v));
      const double distance = glm::length(colour - opposite);
      if (!(distance > farthest)) continue;
      farthest = distance;
      found = colour;
    }
  return found;
}

std::optional<Finder::Colours> Finder::coloursOf(int x, int y, Side other) const {
  std::optional<SideColour> own = unmixed(x, y, Side::own), beside = unmixed(x, y, other);
  if (!own && !beside) return std::nullopt;
  if (!own)
    if (const auto colour = extreme(x, y, Side::own, beside->nearest)) own = SideColour{*colour, *colour};
  if (!beside)
    if (const auto colour = extreme(x, y, other, own->nearest)) beside = SideColour{*colour, *colour};
  if (!own || !beside) return std::nullopt;
  return other == Side::nearer ? Colours{*beside, *own} : Colours{*own, *beside};
}

// The plane of the nearest neighbour on the other side, about the pixel's centre.
std::optional<DepthPlane> Finder::planeOf(int x, int y, Side other) const {
  std::optional<DepthPlane> found;
  int nearest = std::numeric_limits<int>::max();
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const int squared = (u - x) * (u - x) + (v - y) * (v - y);
      if (squared >= nearest || !inside(u, v) || sideOf(x, y, u, v) != other) continue;
      nearest = squared;
      found = moved(planes_.at(u, v), {u - x, v - y});
    }
  return found;
}

// Both colours corrected by what the mixture leaves of the pixel's, each as much as it counts.
void takeApart(const glm::dvec4& colour, const glm::dvec4& nearer, const glm::dvec4& farther, EdgePixel& edge) {
  const double f = edge.share, g = 1.0 - f;
  const glm::dvec4 rest = (colour - f * nearer - g * farther) / (f * f + g * g);
  const glm::dvec4 part = f * (nearer + f * rest);
  for (int c = 0; c < 3; ++c)
    edge.nearerPart[c] = static_cast<float>(colour[c] > 0.0 ? std::clamp(part[c] / colour[c], 0.0, 1.0) : f);
  edge.alpha = static_cast<float>(colour.a);
  const double least = std::max(0.0, (colour.a - g) / f),
               most = std::min(1.0, colour.a / f);  // else the other's is none
  const double nearerAlpha = std::clamp(nearer.a + f * rest.a, std::min(least, most), most);
  edge.nearerAlpha = static_cast<float>(nearerAlpha);
  edge.fartherAlpha = static_cast<float>((colour.a - f * nearerAlpha) / g);
}

// Of the colours as they are and continued, those that explain the pixel's best.
std::optional<Finder::Mixture> Finder::mixtureOf(const glm::dvec4& colour, const Colours& colours) {
  std::optional<Mixture> best;
  for (const glm::dvec4& nearer : {colours.nearer.nearest, colours.nearer.continued})
    for (const glm::dvec4& farther : {colours.farther.nearest, colours.farther.continued}) {
      const glm::dvec4 across = nearer - farther;
      const double length = glm::length(across);
      if (!(length > kContrast * std::max(glm::length(nearer), glm::length(farther)))) continue;
      const double share = std::clamp(glm::dot(colour - farther, across) / (length * length), 0.0, 1.0);
      const double off = glm::length(colour - farther - share * across) / length;
      if (off > kOffLine || (best && !(off < kBetter * best->off))) continue;
      best = Mixture{nearer, farther, share, off};
    }
  return best;
}

// Before nothing at all alpha is the share itself, which no colour tells as well.
void Finder::readAlpha(double alpha, Mixture& mixture) {
  if (std::abs(1.0 - mixture.nearer.a) > kWhole || std::abs(mixture.farther.a) > kWhole) return;
  mixture.nearer.a = 1.0;
  mixture.farther.a = 0.0;
  mixture.share = std::clamp(alpha, 0.0, 1.0);
}

std::optional<EdgePixel> Finder::edgeAt(int x, int y) const {
  if (!isFinite(gbuffer_.beauty.at(x, y))) return std::nullopt;
  for (const auto& [other, mostlyOwn] : besideOf(x, y))
    if (other != Side::own)
      if (const std::optional<EdgePixel> edge = edgeBeside(x, y, other, mostlyOwn)) return edge;
  return std::nullopt;
}

std::optional<EdgePixel> Finder::edgeBeside(int x, int y, Side other, bool mostlyOwn) const {
  const glm::dvec4 colour(gbuffer_.beauty.at(x, y));
  const std::optional<Colours> colours = coloursOf(x, y, other);
  std::optional<Mixture> mixture = colours ? mixtureOf(colour, *colours) : std::nullopt;
  if (!mixture) return std::nullopt;
  const std::optional<DepthPlane> own = planeOf(x, y, Side::own), beside = planeOf(x, y, other);
  if (!own || !beside) return std::nullopt;
  if (std::isinf((other == Side::nearer ? own : beside)->centre)) readAlpha(colour.a, *mixture);
  EdgePixel edge;
  edge.x = x;
  edge.y = y;
  edge.share = mixture->share;
  // A straight edge leaves at least half of the pixel to the surface at its centre; with much less of it colours were
  // taken from where they do not belong.
  if (mostlyOwn && (other == Side::nearer ? 1.0 - edge.share : edge.share) < kLeastOwn) return std::nullopt;
  if (mostlyOwn) edge.share = other == Side::nearer ? std::min(edge.share, 0.5) : std::max(edge.share, 0.5);
  if (!(edge.share > kPure && edge.share < 1.0 - kPure)) return std::nullopt;
  edge.nearer = other == Side::nearer ? *beside : *own;
  edge.farther = other == Side::nearer ? *own : *beside;
  edge.towardsNearer = directionOf(x, y, other);
  takeApart(colour, mixture->nearer, mixture->farther, edge);
  return edge;
}

std::vector<EdgePixel> Finder::find() {
  markSteps();
  markBesideEdges();
  std::vector<std::vector<EdgePixel>> rows(static_cast<std::size_t>(height_));
  tbb::parallel_for(part_.y0, part_.y1, [&](int y) {
    for (int x = part_.x0; x < part_.x1; ++x)
      if (besideEdge_.at(x, y))
        if (const std::optional<EdgePixel> edge = edgeAt(x, y)) rows[static_cast<std::size_t>(y)].push_back(*edge);
  });
  std::vector<EdgePixel> all;
  for (const std::vector<EdgePixel>& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

}  // namespace

std::vector<EdgePixel> edgePixels(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part) {
  return Finder(gbuffer, planes, part).find();
}

std::vector<EdgePixel> edgePixels(const GBuffer& gbuffer, const DepthPlanes& planes) {
  return edgePixels(gbuffer, planes, {0, 0, gbuffer.viewZ.width(), gbuffer.viewZ.height()});
}

}  // namespace pellucid
