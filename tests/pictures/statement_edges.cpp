// Pixels under whose filter more than one opaque face lies.
#include <algorithm>
#include <cmath>

#include "tests/pictures/statement.h"

namespace pellucid::test {
namespace {

using reference::Column;
using reference::Face;
using reference::kNothing;
using reference::Sampled;
using reference::Vec3;
using reference::Vec4;

constexpr int kReach = 3;              // pixels within which a colour has to be seen by itself
constexpr double kContrast = 1.0 / 8;  // of two colours, as a part of the brighter
constexpr double kApart = 1.0 / 128;   // of two faces, as a part of their depth
constexpr double kWholeAlpha = 1.0 / 64;
constexpr double kNoShare = 1.0 / 4096;
constexpr double kEdgeRounding = 3e-5;

}  // namespace

// Whether pixels close by show a face alone, and how much of anything else is in them.
bool Statements::tellsColour(int x, int y, const Face& face, double& impurity) const {
  bool found = false;
  for (int v = y - kReach; v <= y + kReach; ++v)
    for (int u = x - kReach; u <= x + kReach; ++u) {
      bool alone = inside(u, v) && centre(u, v) == face;
      for (int t = v - 1; t <= v + 1 && alone; ++t)
        for (int s = u - 1; s <= u + 1; ++s) alone = alone && (!inside(s, t) || centre(s, t) == face);
      if (!alone) continue;
      found = true;
      impurity = std::max(impurity, glm::length(Vec4(beauty_.at(u, v)) - colourOf(face)));
    }
  return found;
}

// Whether one of two flat faces lies clearly behind the other all around a pixel that has both beside it.
bool Statements::liesBehind(int x, int y, const Face& own, const Face& other) const {
  const auto rayAt = [&](int u, int v) { return reference::rayThrough(picture_.scene().eye, u + 0.5, v + 0.5); };
  bool beside = false;
  double firstFarther = 0.0;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const auto one = reference::depthOfPlane(picture_.scene(), own, rayAt(u, v));
      const auto two = reference::depthOfPlane(picture_.scene(), other, rayAt(u, v));
      if (!one || !two) return false;
      if (std::abs(*one - *two) < kApart * std::min(*one, *two)) return false;
      if (firstFarther * (*two - *one) < 0.0) return false;  // they meet there
      firstFarther = *two > *one ? 1.0 : -1.0;
      beside = beside || centre(u, v) == other;
    }
  return beside;
}

std::optional<Statement> Statements::edgeAt(int x, int y, const Surroundings& around) const {
  // A surface of which the picture ends after two pixels may as well be two: their depths tell no slope.
  if (!flags_.edges || around.faces.size() != 2 || x < 2 || y < 2 || !inside(x + 2, y + 2)) return std::nullopt;
  if (striped_ || (anySolids_ && picture_.anyBends())) return std::nullopt;  // bent rays show either, by the pass
  const Face own = centre(x, y), other = around.faces[0] == own ? around.faces[1] : around.faces[0];
  if (!(around.faces[0] == own || around.faces[1] == own)) return std::nullopt;
  for (int v = y - kReach - 1; v <= y + kReach + 1; ++v)
    for (int u = x - kReach - 1; u <= x + kReach + 1; ++u)
      if (inside(u, v) && !(centre(u, v) == own) && !(centre(u, v) == other)) return std::nullopt;
  double impurity = 0.0;
  if (!liesBehind(x, y, own, other) || !tellsColour(x, y, own, impurity) || !tellsColour(x, y, other, impurity))
    return std::nullopt;
  const Vec4 ownColour = colourOf(own), otherColour = colourOf(other);
  const double contrast = glm::length(ownColour - otherColour);
  if (contrast < kContrast * std::max(glm::length(ownColour), glm::length(otherColour))) return std::nullopt;

  double shares[2] = {0.0, 0.0};
  Range ranges[2];
  bool bent = false;
  const auto takeColumn = [&](const Spot& spot, const Column& column) {
    for (const reference::Crossing& crossing : column.crossings) bent = bent || crossing.bend;
    for (int side = 0; side < 2; ++side) {
      const Face& face = side == 0 ? own : other;
      const double z = faceDepth(face, column.ray);
      const double farther = 1.0 + 3.0 * flags_.depthStep();
      takeCuts(spot, column, face, z, z * farther, side == 0 ? ownColour : otherColour, ranges[side]);
    }
  };
  const auto take = [&](double u, double v) {
    const Spot spot{x, y, {u - x, v - y}};
    takeColumn(spot, picture_.columnAt(u, v));
    for (const reference::CutBand& band : bands_) takeColumn(spot, picture_.columnAt(u, v, band));
  };
  Vec4 mean(0.0);
  samples_.under(x, y, [&](const Sampled& sample, double weight) {
    shares[sample.opaque.face == own ? 0 : 1] += weight;
    mean += weight * sampledValue(x, y, sample);
    take(sample.x, sample.y);
  });
  for (const glm::dvec2& place : places_) take(x + place.x, y + place.y);
  if (bent) return std::nullopt;  // rays that are bent within the edge meet its pixels in part
  const double part = shares[0] / (shares[0] + shares[1]);
  if (part < 0.5) return std::nullopt;  // a corner, or a thing narrower than the pixel
  // A half is off by 2^-12 of itself, and by so much colours do not tell the shares.
  const double stored = flags_.form.half ? 0x1p-11 * (glm::length(ownColour) + glm::length(otherColour)) : 0.0;
  // Either colour is off by as much, or by three times that where it is continued from farther off.
  const double astray = kNoShare + 6.0 * (impurity + stored) / contrast;
  Statement statement{Judged::edge, mean / (shares[0] + shares[1]), Vec4(kEdgeRounding + stored), {}};
  // What layers show and what shines through them may be dealt by shares that are astray, each by itself.
  const Vec4 brightest = glm::max(glm::max(ranges[0].high, ranges[1].high), glm::max(ownColour, otherColour));
  statement.allowed +=
      part * (ranges[0].high - ranges[0].low) + (1.0 - part) * (ranges[1].high - ranges[1].low) + astray * brightest;
  // Before nothing alpha is the share, where colours are seen alone.
  const bool tells = (own.solid < 0 || other.solid < 0) && impurity < kWholeAlpha;
  if (tells) statement.allowed.a -= (astray - kNoShare) * brightest.a;
  return statement;
}

Statement Statements::mixedAt(int x, int y) const {
  std::vector<Face> faces;
  double nearest = kNothing, farthest = 0.0;
  const auto meet = [&](const reference::Met& met) {
    if (std::find(faces.begin(), faces.end(), met.face) == faces.end()) faces.push_back(met.face);
    if (met.z == kNothing) return;
    nearest = std::min(nearest, 0.9 * met.z);
    farthest = std::max(farthest, 1.1 * met.z);
  };
  samples_.under(x, y, [&](const Sampled& sample, double) {
    meet(sample.opaque);
    // The pixel's own surface goes on beyond where it ends, for passes that take the pixel for one surface.
    const reference::Ray ray = reference::rayThrough(picture_.scene().eye, sample.x, sample.y);
    if (!flags_.edges) meet({faceDepth(centre(x, y), ray), centre(x, y)});
  });
  // Where surfaces end the slope of each may be taken from its neighbours' to either side.
  for (int v = y - 2; v <= y + 2; ++v)
    for (int u = x - 2; u <= x + 2; ++u)
      if (inside(u, v)) meet(centres_.at(u, v));
  // Light and transmission apart: edges are taken apart with a weight for each.
  Range light, passed, seen;
  const Vec4 behind(beauty_.at(x, y));
  seen.take(behind);
  // Among stripes a side's colour is that of other pixels.
  for (int v = y - kReach; v <= y + kReach && striped_ && flags_.edges; ++v)
    for (int u = x - kReach; u <= x + kReach; ++u)
      if (inside(u, v)) seen.take(Vec4(beauty_.at(u, v)));
  const auto takeColumn = [&](const Spot& spot, const Column& column) {
    for (const Face& face : faces) {
      const double first = face.solid < 0 ? kNothing : nearest, last = face.solid < 0 ? kNothing : farthest;
      eachCut(column, face, first, last, [&](const reference::Shown& shown) {
        light.take(Vec4(shown.light - shown.lightOff, 0.0));
        light.take(Vec4(shown.light + shown.lightOff, 0.0));
        passed.take(Vec4(shown.transmission, 0.0));
        if (shown.bends.empty()) return;
        // Either surface's colour may be what the others show; among stripes it may have been continued from elsewhere.
        seen.take(anySolids_ || striped_ ? anywhere_ : seenBehind(spot, shown, behind, first, last));
        for (const Face& one : faces) seen.take(colourOf(one));
      });
    }
  };
  const auto take = [&](double u, double v) {
    const Spot spot{x, y, {u - x, v - y}};
    takeColumn(spot, picture_.columnAt(u, v));
    for (const reference::CutBand& band : bands_) takeColumn(spot, picture_.columnAt(u, v, band));
  };
  samples_.under(x, y, [&](const Sampled& sample, double) { take(sample.x, sample.y); });
  for (const glm::dvec2& place : places_) take(x + place.x, y + place.y);
  const auto with = [&](const Vec4& l, const Vec4& t, const Vec4& b) {
    return Vec4(Vec3(l) + Vec3(t) * Vec3(b), 1.0 - (1.0 - b.a) * (t.r + t.g + t.b) / 3.0);
  };
  Range all;
  for (const Vec4& b : {seen.low, seen.high}) {
    all.take(with(light.low, passed.low, b));
    all.take(with(light.high, passed.high, b));
  }
  Statement statement{Judged::mixed, 0.5 * (all.low + all.high), 0.5 * (all.high - all.low) + kEdgeRounding, {}};
  return statement;
}

}  // namespace pellucid::test
