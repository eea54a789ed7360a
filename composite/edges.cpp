#include "composite/edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "composite/object_shares.h"
#include "composite/surface_sides.h"
#include "gbuffer/finite_colour.h"

namespace pellucid {
namespace {

constexpr int kNearestFirst[9][2] = {{0, 0}, {0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
constexpr int kReach = 3;  // pixels in which unmixed neighbours are looked for
static_assert(kSidesAround <= kEdgeSurroundings);
static_assert(2 * kReach < kTouchAround);  // colours are continued from less than twice as far
// Surfaces whose colours differ by less, relative to the brighter, do not tell their shares.
constexpr double kContrast = 1.0 / 16.0;
// How far a mixture may lie from the line between the two colours, as a part of its length.
constexpr double kOffLine = 0.25;
constexpr double kOnLine = 1.0 / 64.0;  // within so much of it no other colours are needed
constexpr double kBetter = 0.8;         // continued colours must lie so much nearer to the line
constexpr double kWhole = 1.0 / 64.0;   // alpha within it of 1 or 0 is that of a whole surface, or of nothing
constexpr double kLeastOwn = 0.25;      // of a pixel whose neighbours lie mostly on its own surface
constexpr double kPure = 1.0 / 4096.0;  // less of a surface is none
constexpr double kTold = 1.0 / 8.0;     // less than this part of how far the mixture lies off the line is none either

class Finder {
 public:
  Finder(const GBuffer& gbuffer, const DepthPlanes& planes, const Window& part)
      : gbuffer_(gbuffer), planes_(planes), part_(part), sides_(gbuffer, planes, part) {}
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
    glm::dvec4 fartherNearest;  // as the picture holds it
    double share;               // of the nearer, [0,1]
    double off;                 // how far the pixel's colour lies from it, as a part of the line's length
    bool byObjects = false;     // the share is that of objects the file tells apart
    bool guessed = false;       // some colour is continued, and seen nowhere
  };
  struct Beside {
    Side other = Side::own;  // own: none of the neighbours lies there
    bool mostlyOwn = false;  // of the 3 x 3 pixels more lie on the pixel's side of the edge
  };
  std::array<Beside, 2> besideOf(int x, int y) const;
  glm::dvec2 directionOf(int x, int y, Side other) const;
  std::optional<SideColour> unmixed(int x, int y, Side side) const;
  glm::dvec4 continued(int x, int y, Side side, const glm::dvec4& colour, glm::dvec2 offset) const;
  bool besideThird(int x, int y, Side other, int u, int v) const;
  std::optional<glm::dvec4> extreme(int x, int y, Side side, Side other, const glm::dvec4& opposite) const;
  static void readAlpha(double alpha, Mixture& mixture);
  static std::optional<Mixture> mixtureOf(const glm::dvec4& colour, const Colours& colours);
  std::optional<Colours> coloursOf(int x, int y, Side other) const;
  std::optional<PlaneNear> planeOf(int x, int y, Side side) const;
  static void setPlanes(const PlaneNear& own, const PlaneNear& beside, Side other, EdgePixel& edge);
  std::optional<Mixture> mixtureAt(int x, int y, Side other) const;
  static bool leavesOwn(Side other, Mixture& mixture);
  bool isAsBeside(int x, int y, const Mixture& mixture) const;
  std::optional<EdgePixel> edgeAt(int x, int y) const;
  std::optional<EdgePixel> edgeBeside(int x, int y, Side other, bool mostlyOwn) const;

  const GBuffer& gbuffer_;
  const DepthPlanes& planes_;
  Window part_;
  SurfaceSides sides_;
};

// First the side on which more of the eight neighbours lie, those that share an edge with the pixel counting twice.
std::array<Finder::Beside, 2> Finder::besideOf(int x, int y) const {
  int weight[3] = {0, 0, 0}, count[3] = {0, 0, 0};
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!sides_.inside(u, v)) continue;
      const auto side = static_cast<std::size_t>(sides_.sideOf(x, y, u, v));
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
      if (!sides_.inside(u, v)) continue;
      const Side side = sides_.sideOf(x, y, u, v);
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
      if (squared > nearest || !sides_.inside(u, v) || sides_.touchesEdge(u, v) || sides_.sideOf(x, y, u, v) != side)
        continue;
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
  if (!sides_.inside(u, v) || sides_.touchesEdge(u, v) || sides_.sideOf(x, y, u, v) != side) return colour;
  const double farther = glm::length(glm::dvec2(u - x, v - y));
  if (!(farther > distance + 0.5) || !isFinite(gbuffer_.beauty.at(u, v))) return colour;
  const glm::dvec4 change = (colour - glm::dvec4(gbuffer_.beauty.at(u, v))) / (farther - distance);
  return glm::max(colour + change * distance, glm::dvec4(0.0));
}

// Whether beside a pixel there is a surface that is neither the one of (x, y) nor on the side in question.
bool Finder::besideThird(int x, int y, Side other, int u, int v) const {
  for (int t = v - 1; t <= v + 1; ++t)
    for (int s = u - 1; s <= u + 1; ++s) {
      const Side side = sides_.inside(s, t) ? sides_.sideOf(x, y, s, t) : Side::own;
      if (side != Side::own && side != other) return true;
    }
  return false;
}

// Of things so narrow that an edge touches every pixel of theirs: the one least like the opposite side, and rather one
// that is mixed with nothing but that.
std::optional<glm::dvec4> Finder::extreme(int x, int y, Side side, Side other, const glm::dvec4& opposite) const {
  std::optional<glm::dvec4> found[2];  // beside two surfaces, beside more
  double farthest[2] = {0.0, 0.0};
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!sides_.inside(u, v) || sides_.sideOf(x, y, u, v) != side) continue;
      const int more = besideThird(x, y, other, u, v) ? 1 : 0;
      const glm::dvec4 colour(gbuffer_.beauty.at(u, v));
      const double distance = glm::length(colour - opposite);
      if (!(distance > farthest[more])) continue;
      farthest[more] = distance;
      found[more] = colour;
    }
  return found[0] ? found[0] : found[1];
}

std::optional<Finder::Colours> Finder::coloursOf(int x, int y, Side other) const {
  std::optional<SideColour> own = unmixed(x, y, Side::own), beside = unmixed(x, y, other);
  if (!own && !beside) return std::nullopt;
  if (!own)
    if (const auto colour = extreme(x, y, Side::own, other, beside->nearest)) own = SideColour{*colour, *colour};
  if (!beside)
    if (const auto colour = extreme(x, y, other, other, own->nearest)) beside = SideColour{*colour, *colour};
  if (!own || !beside) return std::nullopt;
  return other == Side::nearer ? Colours{*beside, *own} : Colours{*own, *beside};
}

// The plane of the nearest pixel on a side.
std::optional<PlaneNear> Finder::planeOf(int x, int y, Side side) const {
  for (const auto& [dx, dy] : kNearestFirst)
    if (sides_.inside(x + dx, y + dy) && sides_.sideOf(x, y, x + dx, y + dy) == side)
      return PlaneNear{planes_.at(x + dx, y + dy), {dx, dy}};
  return std::nullopt;
}

// Each in front of the other where it is seen itself, they meet in a corner between. A plane that lies farther where it
// is seen itself, and before the other here, goes round a ridge. Otherwise one ends before the other, of which a plane
// that has left the picture here tells no more than its depth.
void Finder::setPlanes(const PlaneNear& own, const PlaneNear& beside, Side other, EdgePixel& edge) {
  edge.nearer = other == Side::nearer ? beside : own;
  edge.farther = other == Side::nearer ? own : beside;
  const glm::dvec2 there = beside.from;
  edge.meet = own.z(0.0, 0.0) < beside.z(0.0, 0.0) && beside.z(there.x, there.y) < own.z(there.x, there.y);
  const double besideZ = beside.z(0.0, 0.0);
  if (edge.meet) return;
  if (std::isfinite(besideZ) && besideZ > kAtEye) {
    edge.ridge = other == Side::farther && besideZ < own.z(0.0, 0.0);
    return;
  }
  (other == Side::nearer ? edge.nearer : edge.farther).plane = {beside.plane.centre, 0.0, 0.0,
                                                                beside.plane.orthographic};
}

// Both colours corrected by what the mixture leaves of the pixel's, each as much as it counts.
void takeApart(const glm::dvec4& colour, const glm::dvec4& nearer, const glm::dvec4& farther, EdgePixel& edge) {
  const double f = edge.share, g = 1.0 - f;
  const glm::dvec4 rest = (colour - f * nearer - g * farther) / (f * f + g * g);
  const glm::dvec4 part = f * (nearer + f * rest);
  for (int c = 0; c < 3; ++c)
    edge.nearerPart[c] = static_cast<float>(colour[c] > 0.0 ? std::clamp(part[c] / colour[c], 0.0, 1.0) : f);
  edge.whole = glm::vec3(colour);
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
      if (off > kOffLine || (best && (best->off < kOnLine || !(off < kBetter * best->off)))) continue;
      best = Mixture{nearer, farther, colours.farther.nearest, share, off};
      best->guessed = nearer != colours.nearer.nearest || farther != colours.farther.nearest;
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

// Of the colours on both sides; where they do not tell, of the share that is known otherwise, if any.
std::optional<Finder::Mixture> Finder::mixtureAt(int x, int y, Side other) const {
  const std::optional<Colours> colours = coloursOf(x, y, other);
  if (!colours) return std::nullopt;
  std::optional<Mixture> mixture = mixtureOf(glm::dvec4(gbuffer_.beauty.at(x, y)), *colours);
  if (mixture) return mixture;
  const std::optional<double> share = nearerShare(gbuffer_, sides_, x, y, other);
  if (!share) return std::nullopt;
  return Mixture{colours->nearer.nearest, colours->farther.nearest, colours->farther.nearest, *share, 0.0, true};
}

// A straight edge leaves at least half of the pixel to the surface at its centre; with much less of it colours were
// taken from where they do not belong.
bool Finder::leavesOwn(Side other, Mixture& mixture) {
  const double own = other == Side::nearer ? 1.0 - mixture.share : mixture.share;
  if (own < kLeastOwn) return false;
  if (own < 0.5) mixture.share = 0.5;
  return true;
}

// Whether the colour is that of a pixel close by, on the same surface, that no edge touches: such a pixel is no
// mixture, whatever the mean of those about it is mixed with, as where two sides of a box meet.
bool Finder::isAsBeside(int x, int y, const Mixture& mixture) const {
  const double same = kPure * glm::length(mixture.nearer - mixture.farther);
  const glm::dvec4 colour(gbuffer_.beauty.at(x, y));
  const int reach = mixture.guessed ? kReach : 1;
  for (int v = y - reach; v <= y + reach; ++v)
    for (int u = x - reach; u <= x + reach; ++u)
      if (sides_.inside(u, v) && !sides_.touchesEdge(u, v) &&
          glm::length(colour - glm::dvec4(gbuffer_.beauty.at(u, v))) <= same && sides_.sideOf(x, y, u, v) == Side::own)
        return true;
  return false;
}

std::optional<EdgePixel> Finder::edgeBeside(int x, int y, Side other, bool mostlyOwn) const {
  const glm::dvec4 colour(gbuffer_.beauty.at(x, y));
  std::optional<Mixture> mixture = mixtureAt(x, y, other);
  if (!mixture) return std::nullopt;
  const std::optional<PlaneNear> own = planeOf(x, y, Side::own), beside = planeOf(x, y, other);
  if (!own || !beside) return std::nullopt;
  if (std::isinf((other == Side::nearer ? own : beside)->plane.centre)) readAlpha(colour.a, *mixture);
  if (!mixture->byObjects && isAsBeside(x, y, *mixture)) return std::nullopt;
  if (!mixture->byObjects && mostlyOwn && !leavesOwn(other, *mixture)) return std::nullopt;
  const double least = std::max(kPure, kTold * mixture->off);
  if (!(mixture->share > least && mixture->share < 1.0 - least)) return std::nullopt;
  EdgePixel edge;
  edge.x = x;
  edge.y = y;
  edge.share = mixture->share;
  setPlanes(*own, *beside, other, edge);
  edge.fartherAlone = glm::vec3(mixture->fartherNearest);
  edge.towardsNearer = directionOf(x, y, other);
  takeApart(colour, mixture->nearer, mixture->farther, edge);
  return edge;
}

std::vector<EdgePixel> Finder::find() {
  std::vector<std::vector<EdgePixel>> rows(static_cast<std::size_t>(gbuffer_.viewZ.height()));
  tbb::parallel_for(part_.y0, part_.y1, [&](int y) {
    for (int x = part_.x0; x < part_.x1; ++x)
      if (sides_.touchesEdge(x, y))
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
