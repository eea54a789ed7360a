#include "gbuffer/depth_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "gbuffer/pixel_rows.h"

namespace pellucid {
namespace {

constexpr int kAcross = 96;           // patches along the picture's longer edge
constexpr double kBeyond = 1e9;       // what renderers write for nothing
constexpr std::size_t kFewest = 12;   // patches that decide anything
constexpr std::size_t kShare = 50;    // and one in so many of all: curved things fit a reading here and there
constexpr std::size_t kFarMore = 20;  // times as many as speak for another reading
constexpr double kApart = 4.0;        // a reading is out when a patch misses it by as many tolerances

enum Reading { asPlanar, asRay, asInverse };

// Two roundings of the stored numbers, relative; floats are given what a renderer's own arithmetic loses.
double toleranceOf(const ExrPart& part, const ExrChannel& depth) {
  if (depth.type == PixelType::half) return 0x1p-10;
  return part.compression == "pxr24" ? 0x1p-14 : 0x1p-18;
}

std::size_t placeOf(DepthMeaning meaning) {
  const auto* found = std::find(std::begin(DepthEvidence::kReadings), std::end(DepthEvidence::kReadings), meaning);
  return static_cast<std::size_t>(found - std::begin(DepthEvidence::kReadings));
}

// Along parallel rays the distance to a point is its planar depth.
bool sameReading(const DepthEvidence& evidence, DepthMeaning a, DepthMeaning b) {
  return a == b || (evidence.parallel && a != DepthMeaning::inverse && b != DepthMeaning::inverse);
}

struct Patches {
  const Image<float>& values;
  const ExrPart& part;
  const Camera* camera;  // null: rays are not considered
  double tolerance;
  DepthEvidence evidence;

  // What is linear on a plane under this reading. Seen in perspective that is 1/z; along parallel rays z itself.
  double linear(Reading reading, int x, int y) const {
    const auto value = static_cast<double>(values.at(x, y));
    if (evidence.parallel) return reading == asInverse ? 1.0 / value : value;
    if (reading == asInverse) return value;
    const double length =
        reading == asRay ? rayOverPlanar(*camera, part.display, part.data.x0 + x + 0.5, part.data.y0 + y + 0.5) : 1.0;
    return length / value;
  }
  // How far the middle three of five points in line are from the line through the outer two, relative.
  double missOf(Reading reading, int x, int y, int dx, int dy) const {
    const double first = linear(reading, x - 2 * dx, y - 2 * dy), last = linear(reading, x + 2 * dx, y + 2 * dy);
    double worst = 0;
    for (int i = 1; i < 4; ++i) {
      const double expected = first + (last - first) * i / 4.0;
      const double found = linear(reading, x + (i - 2) * dx, y + (i - 2) * dy);
      worst = std::max(worst, std::abs(found - expected) / std::abs(expected));
    }
    return worst;
  }
  bool hit(int x, int y) const {
    const float value = values.at(x, y);
    return value > 0.0f && static_cast<double>(value) < kBeyond;
  }
  // The patch of five pixels in each of four directions around (x, y).
  void look(int x, int y, int step) {
    const std::pair<int, int> directions[] = {{step, 0}, {0, step}, {step, step}, {step, -step}};
    for (const auto& [dx, dy] : directions)
      for (int i = -2; i <= 2; ++i)
        if (!hit(x + i * dx, y + i * dy)) return;
    ++evidence.patches;
    double miss[3] = {};
    for (const Reading reading : {asPlanar, asRay, asInverse})
      for (const auto& [dx, dy] : directions)
        miss[reading] =
            std::max(miss[reading], reading == asRay && !camera ? 2.0 * tolerance : missOf(reading, x, y, dx, dy));
    for (int fits = 0; fits < 3; ++fits)
      for (int out = 0; out < 3; ++out)
        evidence.over[fits][out] += miss[fits] <= tolerance && miss[out] > kApart * tolerance;
  }
};

void measureRange(const Image<float>& values, DepthEvidence& evidence) {
  bool any = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    if (!std::isfinite(value) || value == 0.0 || std::abs(value) >= kBeyond) continue;
    evidence.least = any ? std::min(evidence.least, value) : value;
    evidence.most = any ? std::max(evidence.most, value) : value;
    any = true;
    ++(value > 0.0 ? evidence.positive : evidence.negative);
  }
}

}  // namespace

DepthEvidence depthEvidence(const ExrPart& part, const ExrChannel& depth, const Camera* camera) {
  const int width = part.data.width(), height = part.data.height();
  Image<float> values(width, height);
  visitPixels(depth, part.data, part.data, [&](int x, int y, float value) { values.at(x, y) = value; });
  Patches patches{values, part, camera, toleranceOf(part, depth), {}};
  patches.evidence.parallel = camera && camera->orthographic;
  measureRange(values, patches.evidence);
  if (patches.evidence.negative > 0 && patches.evidence.positive == 0)
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = -values[i];
  const int longer = std::max(width, height), every = std::max(1, longer / kAcross);
  // Short ones find small planes; long ones bend enough to be told apart.
  for (const int part64 : {1, 3, 6, 10}) {
    const int step = std::max(1, longer * part64 / 64), reach = 2 * step;
    for (int y = reach; y < height - reach; y += every)
      for (int x = reach; x < width - reach; x += every) patches.look(x, y, step);
  }
  return patches.evidence;
}

bool speaksFor(const DepthEvidence& evidence, DepthMeaning meaning, DepthMeaning against) {
  const std::size_t votes = evidence.over[placeOf(meaning)][placeOf(against)];
  return votes >= std::max(kFewest, evidence.patches / kShare) &&
         votes > kFarMore * evidence.over[placeOf(against)][placeOf(meaning)];
}

std::optional<DepthMeaning> spokenFor(const DepthEvidence& evidence, const DepthKind& kind) {
  for (const DepthMeaning meaning : DepthEvidence::kReadings) {
    if (!kind.mayBe(meaning)) continue;
    const bool all =
        std::all_of(std::begin(DepthEvidence::kReadings), std::end(DepthEvidence::kReadings), [&](DepthMeaning other) {
          return !kind.mayBe(other) || sameReading(evidence, meaning, other) || speaksFor(evidence, meaning, other);
        });
    if (all) return meaning;
  }
  return std::nullopt;
}

std::string evidenceText(const DepthEvidence& evidence, DepthMeaning meaning, DepthMeaning against) {
  return fmt::format("{} of {} patches lie on planes as {} and not as {}, {} the other way",
                     evidence.over[placeOf(meaning)][placeOf(against)], evidence.patches, depthKindText({meaning}),
                     depthKindText({against}), evidence.over[placeOf(against)][placeOf(meaning)]);
}

}  // namespace pellucid
