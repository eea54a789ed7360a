#include "tests/pictures/statement.h"

#include <algorithm>
#include <cmath>

#include "gbuffer/depth_plane.h"

namespace pellucid::test {
namespace {

using reference::Column;
using reference::Face;
using reference::kNothing;
using reference::Sampled;
using reference::Shown;
using reference::Vec2;
using reference::Vec3;
using reference::Vec4;

// Of the values themselves: colours are floats, and so are the products of a few layers.
constexpr double kRounding = 1e-5;
// Of a range: another surface that may be seen was seen as far aside as places are off, and shows other light there.
constexpr double kAside = 1e-3;
constexpr double kWide = 0.01;  // of such a margin, pixels: within it more than one edge may lie
constexpr int kFewPasses = 4;   // may all see what few places see
// Across the square that a pass stands for: of more than one, coarser levels of a texture count, and devices may take
// 0.7 for 1.
constexpr double kMostTexels = 0.7;
constexpr int kMostPlaces = 150;  // of those that would show it
constexpr int kAcross = 3;        // places in each pixel at which meshes are looked at
constexpr int kNear = 5;          // pixels within which another face may touch the slope of this one

}  // namespace

double Statement::error(const Vec4& value) const {
  double largest = 0.0;
  for (int c = 0; c < 4; ++c) {
    const double off = std::abs(value[c] - right[c]) / allowed[c];
    largest = std::max(largest, std::isfinite(off) ? off : 1e9);
  }
  return largest;
}

void Statements::Range::take(const Vec4& value) {
  low = glm::min(low, value);
  high = glm::max(high, value);
}
void Statements::Range::take(const Range& other) {
  take(other.low);
  take(other.high);
}

Statements::Statements(const DrawnScene& scene, const reference::Picture& picture, const reference::Samples& samples,
                       const DrawnFlags& flags, const Image<glm::vec4>& beauty, std::vector<glm::dvec2> places)
    : picture_(picture),
      samples_(samples),
      flags_(flags),
      beauty_(beauty),
      places_(std::move(places)),
      centres_(beauty.width(), beauty.height()),
      size_(scene.size) {
  for (int y = 0; y < centres_.height(); ++y)
    for (int x = 0; x < centres_.width(); ++x)
      centres_.at(x, y) =
          reference::nearestSolid(picture.scene(), reference::rayThrough(picture.scene().eye, x + 0.5, y + 0.5));
  // The square that a pass stands for is what the density of all of them at the filter's middle leaves to each.
  edge_ = std::max(1.0, 2.0 * flags.filter.radius) / std::sqrt(static_cast<double>(flags.passes));
  std::vector<int> masks;
  for (std::size_t m = 0; m < picture.scene().meshes.size(); ++m)
    if (picture.scene().meshes[m].coat.covering == reference::Covering::mask && flags.softMask)
      masks.push_back(static_cast<int>(m));
  for (const int side : {-1, 1}) {
    for (const int mesh : masks) bands_.push_back({edge_, side, mesh});
    if (masks.size() < 2) continue;
    bands_.push_back({edge_, side});
    for (const int mesh : masks) bands_.push_back({edge_, side, -1, mesh});  // through one rim another is seen
  }
  for (const reference::Mesh& mesh : picture.scene().meshes) {
    const bool covers = mesh.coat.covering == reference::Covering::mask || mesh.coat.colour.a >= 1.0;
    // Metal lets nothing through, whatever its transmission.
    const bool tight = !mesh.coat.glass || mesh.coat.finish.metal >= 1.0 || mesh.coat.finish.passes <= 0.0;
    anySolids_ = anySolids_ || (tight && covers);
  }
  for (const reference::Solid& solid : picture.scene().solids) striped_ = striped_ || solid.stripes != Vec3(0.0);
  if (anySolids_) {
    anywhere_.take(Vec4(0.0));
    anywhere_.take(Vec4(1.0));
    takeSolids();
  }
  for (std::size_t i = 0; i < beauty.size(); ++i) anywhere_.take(Vec4(beauty[i]));
  // A corner comes to the eye through one product of floats: as far as the mesh's origin lies from the eye, and the
  // corner from that origin.
  const reference::Eye& eye = picture.scene().eye;
  for (std::size_t i = 0; i < scene.placed.size(); ++i) {
    glm::dmat4 world(1.0);
    for (const glm::dmat4& node : scene.placed[i].nodes) world = world * node;
    const double away = glm::length(Vec3(world[3]) - eye.at);
    for (const reference::Corner& corner : picture.scene().meshes[i].corners)
      rounding_ = std::max(rounding_, 0x1p-22 * (away + glm::length(corner.at - Vec3(world[3]))));
  }
}

// What bent rays may land on: all light of meshes that hide everything, lamps' highlights included.
void Statements::takeSolids() {
  if (!picture_.anyBends()) return;
  for (int y = 0; y < kAcross * centres_.height(); ++y)
    for (int x = 0; x < kAcross * centres_.width(); ++x)
      for (const reference::Crossing& crossing :
           picture_.columnAt((x + 0.5) / kAcross, (y + 0.5) / kAcross).crossings) {
        if (!reference::hidesAll(crossing.layer)) continue;
        const auto &shows = crossing.layer.reflected, &glows = crossing.layer.additive;
        anywhere_.take(Vec4(shows[0] + glows[0], shows[1] + glows[1], shows[2] + glows[2], 1.0));
      }
}

Vec4 Statements::colourOf(const Face& face) const {
  return face.solid < 0 ? Vec4(0.0) : Vec4(picture_.scene().solids[static_cast<std::size_t>(face.solid)].colour, 1.0);
}

Vec4 Statements::valueOf(const Shown& shown, const Vec4& behind) const {
  const double passed = (shown.transmission.r + shown.transmission.g + shown.transmission.b) / 3.0;
  return {shown.over(Vec3(behind)), 1.0 - (1.0 - behind.a) * passed};
}

double Statements::faceDepth(const Face& face, const reference::Ray& ray) const {
  const bool behind = face.solid >= 0 && picture_.scene().eye.parallel;
  return reference::depthOfPlane(picture_.scene(), face, ray).value_or(behind ? kAtEye : kNothing);
}

// By how much the depth of a ball leaves its plane within a pixel.
double Statements::bendOf(int x, int y) const {
  const auto at = [&](int u, int v) { return inside(u, v) ? centres_.at(u, v).z : kNothing; };
  double bend = 0.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}})
    bend = std::max(bend, std::abs(at(x + dx, y + dy) + at(x - dx, y - dy) - 2.0 * at(x, y)));
  return bend * std::max(1.0, 2.0 * flags_.filter.radius * flags_.filter.radius);
}

Statements::Surroundings Statements::surroundingsOf(int x, int y) const {
  Surroundings around;
  samples_.under(x, y, [&](const Sampled& sample, double) {
    if (std::find(around.faces.begin(), around.faces.end(), sample.opaque.face) == around.faces.end())
      around.faces.push_back(sample.opaque.face);
  });
  const Face& face = centre(x, y);
  if (face.solid < 0) return around;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
    int run[2] = {0, 0};
    for (int side = 0; side < 2; ++side)
      for (int k = 1; k <= kNear; ++k) {
        const int u = x + (side ? -k : k) * dx, v = y + (side ? -k : k) * dy;
        if (!inside(u, v)) break;
        if (!(centre(u, v) == face)) {
          around.beside = 6.0 * flags_.depthStep();
          break;
        }
        run[side] = k;
      }
    around.onPlane = around.onPlane && ((run[0] > 0 && run[1] > 0) || run[0] > 1 || run[1] > 1);
  }
  const auto& shape = picture_.scene().solids[static_cast<std::size_t>(face.solid)].shape;
  if (!std::holds_alternative<reference::Ball>(shape)) return around;
  // A pass may look past a limb that no sample of the picture has found.
  for (const glm::dvec2& place : places_) {
    const Face seen = picture_.columnAt(x + place.x, y + place.y).opaque.face;
    if (std::find(around.faces.begin(), around.faces.end(), seen) == around.faces.end()) around.faces.push_back(seen);
  }
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) around.onPlane = around.onPlane && inside(u, v) && centre(u, v) == face;
  around.beside += 5.0 * flags_.depthStep();
  return around;
}

Statement Statements::innerAt(int x, int y, const Surroundings& around) const {
  Vec4 sum(0.0), squares(0.0), low(0.0), high(0.0);
  const Face& face = centre(x, y);
  const Vec4 behind(beauty_.at(x, y));
  const double step = flags_.depthStep(), reach = std::max(1.0, 2.0 * flags_.filter.radius);
  const bool flat =
      face.solid < 0 ||
      reference::depthOfPlane(picture_.scene(), face, reference::rayThrough(picture_.scene().eye, x + 0.5, y + 0.5));
  const double bend = flat || flags_.passes == 1 ? 0.0 : bendOf(x, y);
  std::vector<Column> columns;
  for (const glm::dvec2& place : places_) columns.push_back(picture_.columnAt(x + place.x, y + place.y));
  const double margin = marginOf(columns);
  const auto depthOf = [&](const Column& column) { return flat ? faceDepth(face, column.ray) : column.opaque.z; };
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Vec2 at = Vec2(x, y) + places_[i];
    const Spot spot{x, y, places_[i]};
    const Shown shown = picture_.shownBefore(columns[i], face, depthOf(columns[i]));
    const Vec4 nominal = valueOf(shown, exactlyBehind(spot, shown, behind, depthOf(columns[i])));
    Range range;
    range.take(nominal);
    const auto take = [&](const Column& column) {
      const double z = depthOf(column), farther = (2.0 * step + around.beside) * reach * z + bend;
      takeCuts(spot, column, face, z == kNothing ? z : z - around.beside * reach * z - bend,
               z == kNothing ? z : z + farther, behind, range);
    };
    take(columns[i]);
    for (const double part : margin > kWide ? std::vector<double>{1.0, 0.6, 0.3} : std::vector<double>{1.0})
      for (const Vec2 off : {Vec2(1, 1), Vec2(1, -1), Vec2(-1, 1), Vec2(-1, -1)})
        take(picture_.columnAt(at.x + part * margin * off.x, at.y + part * margin * off.y));
    for (const reference::CutBand& band : bands_) {
      const Column cut = picture_.columnAt(at.x, at.y, band);
      take(cut);
      eachPartly(cut, columns[i], take);
      eachPartly(columns[i], cut, take);
    }
    sum += nominal;
    squares += nominal * nominal;
    low += range.low;
    high += range.high;
  }
  const double count = static_cast<double>(places_.size());
  Statement statement{Judged::inner, sum / count, Vec4(0.0), Vec4(0.0)};
  statement.variance = glm::max(squares / count - statement.right * statement.right, Vec4(0.0));
  const double brightest = std::max({1.0, high.r / count, high.g / count, high.b / count});
  statement.allowed = glm::max(high / count - statement.right, statement.right - low / count) +
                      kAside * (high - low) / count + kRounding * brightest;
  return statement;
}

Statement Statements::filteredAt(int x, int y, const Statement& inner) const {
  Vec4 sum(0.0), squares(0.0);
  double weights = 0.0, weightSquares = 0.0;
  Range seen;
  seen.take(inner.right);
  int count = 0, number = 0;
  samples_.under(x, y, [&](const Sampled&, double) { ++count; });
  // Where bent rays show transparent meshes, some of the places stand for all.
  int step = anySolids_ && picture_.anyBends() ? std::max(count / kMostPlaces, 1) : 1;
  while (step > 1 && (step % 2 == 0 || step % 3 == 0)) ++step;  // rows of them are a multiple of 6
  samples_.under(x, y, [&](const Sampled& sample, double weight) {
    if (number++ % step != 0) return;
    const Vec4 value = sampledValue(x, y, sample);
    seen.take(value);
    sum += weight * value;
    squares += weight * value * value;
    weights += weight;
    weightSquares += weight * weight;
  });
  const Vec4 mean = sum / weights;
  // What is smaller than the distance of places is met by the passes or by these, and by chance.
  const Vec4 variance = glm::max(squares / weights - mean * mean, inner.variance);
  if (flags_.passes <= kFewPasses)
    return {Judged::filtered, mean, inner.allowed + glm::max(seen.high - mean, mean - seen.low), variance};
  const double noise = 1.0 / flags_.passes + weightSquares / (weights * weights);
  // Passes count in whole ones: what a hundredth of the pixel shows is seen by none of five, or by a fifth of them.
  const Vec4 half = (seen.high - seen.low) / (2.0 * flags_.passes);
  return {Judged::filtered, mean, inner.allowed + 3.0 * glm::sqrt(variance * noise) + half, variance};
}

// Beside an edge and a third face, or stripes, a pixel of one face is no telling from one that is mixed a little.
bool Statements::maybeTakenApart(int x, int y) const {
  if (!flags_.edges) return false;
  std::vector<Face> faces;
  bool beside = false;
  for (int v = y - 3; v <= y + 3; ++v)
    for (int u = x - 3; u <= x + 3; ++u) {
      if (!inside(u, v)) continue;
      if (std::find(faces.begin(), faces.end(), centre(u, v)) == faces.end()) faces.push_back(centre(u, v));
      beside = beside || (std::abs(u - x) < 2 && std::abs(v - y) < 2 && !(centre(u, v) == centre(x, y)));
    }
  return striped_ ? faces.size() > 1 : beside && faces.size() > 2;
}

// Whether the coarser levels of a texture count, of which the reference has none.
bool Statements::hasCoarseTexels(int x, int y) const {
  return std::any_of(places_.begin(), places_.end(), [&](const glm::dvec2& place) {
    return edge_ * picture_.texelsAPixel(x + place.x, y + place.y) > kMostTexels;
  });
}

std::vector<Statement> Statements::of(int x, int y) const {
  if (hasCoarseTexels(x, y)) return {};
  const Surroundings around = surroundingsOf(x, y);
  if (flags_.passes == 1) return {innerAt(x, y, around)};
  const bool alone = around.faces.size() == 1 && around.faces[0] == centre(x, y);
  if (alone && around.onPlane && !maybeTakenApart(x, y)) {
    const Statement inner = innerAt(x, y, around);
    return {inner, filteredAt(x, y, inner)};
  }
  if (const auto edge = edgeAt(x, y, around)) return {*edge};
  return {mixedAt(x, y)};
}

}  // namespace pellucid::test
