// What bent rays show: another place of the picture that the file holds, and of what transparent meshes hide it with.
#include <algorithm>
#include <cmath>

#include "tests/pictures/statement.h"

namespace pellucid::test {
namespace {

using reference::Column;
using reference::Crossing;
using reference::Landing;
using reference::Shown;
using reference::Vec2;
using reference::Vec4;

constexpr double kInFront = 0.9999;   // of a layer's depth: what is nearer is never seen through it
constexpr double kInFrontOff = 1e-6;  // by which floats miss that
constexpr double kTilt = 4e-6;        // of normals that are floats, radians
constexpr double kOfReach = 5e-7;     // by which floats miss a place in the picture
constexpr int kSeen = 3;              // pixels within which a surface of an edge is seen by itself
constexpr double kMostPixels = 4.0;   // between which a place is looked for

}  // namespace

// Where transparent meshes hide the picture in a pass, whatever lies behind.
std::vector<Statements::Texel> Statements::backdropOf(int x, int y, const Column& column, bool exactly) const {
  const reference::Face& face = centre(x, y);
  bool alone = true;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) alone = alone && inside(u, v) && centre(u, v) == face;
  const auto flat = reference::depthOfPlane(picture_.scene(), face, column.ray);
  const double z = flat ? *flat : column.opaque.face == face ? column.opaque.z : faceDepth(face, column.ray);
  const double off = flat && alone ? 8.0 * flags_.depthStep() : reference::kNothing;
  std::vector<Texel> texels;
  for (const Crossing& crossing : column.crossings) {
    if (!reference::hidesAll(crossing.layer)) continue;
    const double at = crossing.layer.z;
    const bool touches = face.solid >= 0 && crossing.on == face;
    if (exactly && !touches && at > z) break;
    if (!exactly && off != reference::kNothing && !touches && at > z * (1.0 + off) + 4.0 * rounding_) break;
    const auto& shows = crossing.layer.reflected;
    const auto& glows = crossing.layer.additive;
    // The backdrop is as near as the nearer of the mesh and the picture's depth, which is that of pixel centres.
    texels.push_back(
        {Vec4(shows[0] + glows[0], shows[1] + glows[1], shows[2] + glows[2], 1.0), std::min(at, centres_.at(x, y).z)});
    const bool clearlyBefore = off != reference::kNothing && at < z * (1.0 - off) - 4.0 * rounding_ * crossing.steep;
    if (exactly || touches || clearlyBefore) return texels;
  }
  texels.push_back({Vec4(beauty_.at(x, y)), centres_.at(x, y).z});
  return texels;
}

std::vector<Statements::Texel> Statements::texelsAt(int x, int y, const Vec2& place, bool exactly) const {
  x = std::clamp(x, 0, centres_.width() - 1);
  y = std::clamp(y, 0, centres_.height() - 1);
  if (!anySolids_) return {{Vec4(beauty_.at(x, y)), centres_.at(x, y).z}};
  const Column column = picture_.columnAt(x + place.x, y + place.y);
  if (exactly) return backdropOf(x, y, column, true);
  std::vector<Texel>& kept = texels_[{place.x, place.y, static_cast<double>(x), static_cast<double>(y)}];
  if (!kept.empty()) return kept;
  const auto take = [&](const Column& one) {
    for (const Texel& texel : backdropOf(x, y, one, false))
      if (std::find(kept.begin(), kept.end(), texel) == kept.end()) kept.push_back(texel);
  };
  take(column);
  const double margin = marginOf({column});
  for (const Vec2 off : {Vec2(1, 1), Vec2(1, -1), Vec2(-1, 1), Vec2(-1, -1)})
    take(picture_.columnAt(x + place.x + margin * off.x, y + place.y + margin * off.y));
  for (const reference::CutBand& band : bands_) take(picture_.columnAt(x + place.x, y + place.y, band));
  return kept;
}

// What a pixel of an edge may show where something in it stands in front of the layer: the farther surface by itself,
// of which pixels close by tell the colour.
void Statements::takeFarther(int x, int y, double limit, Range& range) const {
  if (!flags_.edges || flags_.passes < 2) return;
  x = std::clamp(x, 0, centres_.width() - 1);
  y = std::clamp(y, 0, centres_.height() - 1);
  bool nearer = false;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) nearer = nearer || (inside(u, v) && centres_.at(u, v).z < limit);
  if (!nearer) return;
  for (int v = y - kSeen; v <= y + kSeen; ++v)
    for (int u = x - kSeen; u <= x + kSeen; ++u)
      if (inside(u, v) && centres_.at(u, v).z >= limit) range.take(Vec4(beauty_.at(u, v)));
}

Statements::Range Statements::lookedUp(const Spot& spot, const Vec2& position, const Vec4& behind, double layerZ,
                                       bool exactly) const {
  const Vec4 held(beauty_.at(spot.x, spot.y));
  const Vec2 corner = position - 0.5, first = glm::floor(corner), part = corner - first;
  Vec4 low(0.0), high(0.0);
  double shares = 0.0;
  bool mayDiffer = false;  // in which pixels count
  Range any;
  for (int k = 0; k < 4; ++k) {
    const double share = (k & 1 ? part.x : 1.0 - part.x) * (k >> 1 ? part.y : 1.0 - part.y);
    if (!(share > 0.0)) continue;
    const int x = static_cast<int>(first.x) + (k & 1), y = static_cast<int>(first.y) + (k >> 1);
    Range one;
    bool shows = false, hidden = false;
    const bool own = x == spot.x && y == spot.y;
    for (const Texel& texel : texelsAt(x, y, spot.place, exactly)) {
      const double limit = kInFront * layerZ, off = exactly ? 0.0 : kInFrontOff + 2.0 * flags_.depthStep();
      const bool mayShow = own || texel.z >= limit * (1.0 - off), mayHide = !own && texel.z < limit * (1.0 + off);
      hidden = hidden || (exactly ? !mayShow : mayHide);
      shows = shows || mayShow;
      if (mayShow) one.take(own && texel.colour == held ? behind : texel.colour);
    }
    if (!exactly && shows && !own)
      takeFarther(x, y, kInFront * layerZ * (1.0 + kInFrontOff + 2.0 * flags_.depthStep()), one);
    if (!shows) continue;
    any.take(one);
    mayDiffer = mayDiffer || hidden;
    low += share * one.low;
    high += share * one.high;
    shares += share;
  }
  if (shares > 0.0 && !mayDiffer) {
    any.low = low / shares;
    any.high = high / shares;
    return any;
  }
  // The straight ray's pixel where nothing else shows.
  for (const Texel& texel : texelsAt(spot.x, spot.y, spot.place, exactly))
    any.take(texel.colour == held ? behind : texel.colour);
  return any;
}

Statements::Range Statements::seenBehind(const Spot& spot, const Shown& shown, const Vec4& behind, double first,
                                         double last) const {
  Range seen;
  if (shown.bends.empty()) {
    seen.take(behind);
    return seen;
  }
  const reference::PictureScene& scene = picture_.scene();
  Vec2 low[3], high[3];
  double nearest = reference::kNothing, farthest = 0.0;
  for (int c = 0; c < 3; ++c) low[c] = Vec2(1e300), high[c] = Vec2(-1e300);
  // Layers are met up to beyond the depth, which is itself rounded to either side.
  const double rounded = last == reference::kNothing ? 0.0 : last - first + flags_.depthStep() * first;
  for (const double z : {first - rounded, last})
    for (const Vec2 tilt : {Vec2(0, 0), Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
      const Landing landing =
          reference::landingOf(scene.eye, scene.bending, shown.bends, std::min(z, shown.solidZ), kTilt * tilt);
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = glm::min(low[c], landing.offset[c] - kOfReach * landing.reach);
        high[c] = glm::max(high[c], landing.offset[c] + kOfReach * landing.reach);
      }
      nearest = std::min(nearest, landing.z);
      farthest = std::max(farthest, landing.z);
    }
  const Vec2 middle(spot.x + 0.5, spot.y + 0.5);
  std::vector<double> depths{nearest};
  if (farthest > nearest) depths.push_back(farthest);
  Range channel;
  for (glm::length_t c = 0; c < 3; ++c) {
    const Vec2 width = high[c] - low[c];
    if (std::max(width.x, width.y) > kMostPixels) return anywhere_;
    const Vec2 from = middle + low[c], to = middle + high[c];
    std::vector<double> along[2];
    for (glm::length_t axis = 0; axis < 2; ++axis) {
      along[axis] = {from[axis], to[axis]};
      // In between, values bend at the pixels' centres alone, and beyond the picture they stay what they are.
      const double size = axis == 0 ? centres_.width() : centres_.height();
      const double begin = std::clamp(std::floor(from[axis] - 0.5) + 1.5, -0.5, size + 0.5);
      for (double at = begin; at < std::min(to[axis], size + 0.5); at += 1.0) along[axis].push_back(at);
    }
    if (c == 0 || low[c] != low[c - 1] || high[c] != high[c - 1]) {
      channel = Range();
      for (const double x : along[0])
        for (const double y : along[1])
          for (const double z : depths) channel.take(lookedUp(spot, {x, y}, behind, z, false));
    }
    seen.low[c] = channel.low[c];
    seen.high[c] = channel.high[c];
    if (c != 1) continue;
    seen.low.a = channel.low.a;
    seen.high.a = channel.high.a;
  }
  return seen;
}

Vec4 Statements::exactlyBehind(const Spot& spot, const Shown& shown, const Vec4& behind, double z) const {
  if (shown.bends.empty()) return behind;
  const reference::PictureScene& scene = picture_.scene();
  const Landing landing = reference::landingOf(scene.eye, scene.bending, shown.bends, std::min(z, shown.solidZ));
  Vec4 seen, value;
  for (glm::length_t c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    const Vec2 at = Vec2(spot.x + 0.5, spot.y + 0.5) + landing.offset[k];
    if (c == 0 || landing.offset[k] != landing.offset[k - 1]) value = lookedUp(spot, at, behind, landing.z, true).low;
    seen[c] = value[c];
    if (c == 1) seen.a = value.a;
  }
  return seen;
}

Vec4 Statements::sampledValue(int x, int y, const reference::Sampled& sample) const {
  if (!picture_.anyBends() && !striped_) return sample.value;
  const Column column = picture_.columnAt(sample.x, sample.y);
  const Shown shown = picture_.shownBefore(column);
  const Spot spot{x, y, {sample.x - x, sample.y - y}};
  return shown.bends.empty() && !striped_
             ? sample.value
             : valueOf(shown, exactlyBehind(spot, shown, Vec4(beauty_.at(x, y)), column.opaque.z));
}

}  // namespace pellucid::test
