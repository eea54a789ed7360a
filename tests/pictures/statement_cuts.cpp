// What is shown before an opaque face whose depth is known to within a range.
#include <algorithm>
#include <cmath>

#include "tests/pictures/statement.h"

namespace pellucid::test {
namespace {

using reference::Column;
using reference::Face;
using reference::kNothing;
using reference::Shown;
using reference::Vec4;

// Of a place in the picture, pixels: the rays of a pass are those of floats.
constexpr double kPlace = 1e-4;
constexpr double kAlmost = 1.0 - 1e-12;  // of a coverage of 1

}  // namespace

// Pixels by which floats move what rays meet at the depths that lie in a pixel.
double Statements::marginOf(const std::vector<Column>& columns) const {
  const reference::Eye& eye = picture_.scene().eye;
  double z = 0.5 * size_;
  for (const Column& column : columns) {
    z = std::min(z, column.opaque.z);
    for (const reference::Crossing& crossing : column.crossings) z = std::min(z, crossing.layer.z);
  }
  return kPlace + rounding_ * eye.displayWidth / (2.0 * eye.half.x * (eye.parallel ? 1.0 : z));
}

void Statements::eachCut(const Column& column, const Face& face, double nearest, double farthest,
                         const std::function<void(const Shown&)>& take) const {
  Column loose = column;
  bool any = false;
  for (reference::Crossing& crossing : loose.crossings) {
    if (face.solid < 0) break;
    // Floats do not keep it on its face to the precision of the depth.
    if (!(crossing.on == face) || rounding_ * crossing.steep < 0.25 * flags_.depthStep() * crossing.layer.z) continue;
    crossing.on = Face();
    any = true;
  }
  if (any) eachCut(loose, face, nearest, farthest, take);
  // At a rim what hides everything covers a part of the pass, and is a layer.
  Column partly = column;
  bool rims = false;
  for (reference::Crossing& crossing : partly.crossings) {
    const bool rim =
        picture_.anyBends() && !bands_.empty() && reference::hidesAll(crossing.layer) &&
        picture_.scene().meshes[static_cast<std::size_t>(crossing.mesh)].coat.covering == reference::Covering::mask;
    if (rim) crossing.layer.coverage = kAlmost;
    rims = rims || rim;
  }
  if (rims) eachCut(partly, face, nearest, farthest, take);
  // What touches a face shows at whatever depth lies behind it, but the air ends at the depth itself, which is rounded
  // to either side.
  const bool foggy = picture_.scene().air.density > 0.0 && farthest != kNothing;
  const double rounded = farthest - nearest + flags_.depthStep() * nearest;
  const auto takeCut = [&](const Column& cut, double z) {
    take(picture_.shownBefore(cut, face, z));
    if (!foggy) return;
    for (const double end : {nearest - rounded, nearest + rounded}) take(picture_.shownBefore(cut, face, z, end));
  };
  std::vector<Column> orders{column};
  std::vector<double> depths{nearest, farthest};
  for (std::size_t i = 0; i < column.crossings.size(); ++i) {
    const reference::Crossing& crossing = column.crossings[i];
    const double off = rounding_ * crossing.steep, z = crossing.layer.z;
    if (z + off > nearest && z - off < farthest) depths.insert(depths.end(), {z - 2.0 * off, z + 2.0 * off});
    if (i == 0 || z - column.crossings[i - 1].layer.z > off + rounding_ * column.crossings[i - 1].steep) continue;
    Column other = column;  // which of the two is nearer floats do not tell
    std::swap(other.crossings[i - 1], other.crossings[i]);
    std::swap(other.crossings[i - 1].layer.z, other.crossings[i].layer.z);
    orders.push_back(other);
  }
  for (const Column& order : orders)
    for (const double depth : depths) takeCut(order, depth);
}

void Statements::eachPartly(const Column& more, const Column& fewer,
                            const std::function<void(const Column&)>& take) const {
  // However little of it bends all that is behind, and stripes lie between.
  for (int step = 0; step <= 50; ++step) {
    const double part = std::clamp(0.02 * step, 1e-4, 1.0 - 1e-4);
    Column partly = more;
    bool any = false;
    for (reference::Crossing& crossing : partly.crossings) {
      const bool both = std::any_of(fewer.crossings.begin(), fewer.crossings.end(), [&](const auto& other) {
        return other.mesh == crossing.mesh && other.layer.z == crossing.layer.z;
      });
      if (both || !crossing.bend) continue;
      crossing.layer.coverage *= part;
      crossing.bend->weight *= part;
      any = true;
    }
    if (any) take(partly);
  }
}

void Statements::takeCuts(const Spot& spot, const Column& column, const Face& face, double nearest, double farthest,
                          const Vec4& behind, Range& range) const {
  eachCut(column, face, nearest, farthest,
          [&](const Shown& shown) { range.take(rangeOf(spot, shown, behind, nearest, farthest)); });
}

Statements::Range Statements::rangeOf(const Spot& spot, const Shown& shown, const Vec4& behind, double first,
                                      double last) const {
  const Range seen = seenBehind(spot, shown, behind, first, last);
  const Vec4 off(shown.lightOff, 0.0);
  Range range;
  range.take(valueOf(shown, seen.low) - off);
  range.take(valueOf(shown, seen.high) + off);
  return range;
}

}  // namespace pellucid::test
