#include "gbuffer/depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gbuffer/depth_evidence.h"
#include "gbuffer/errors.h"
#include "gbuffer/pixel_rows.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// Relative spacing of the stored numbers, twice over: the file's rounding and that of what is compared with it.
// Floats are given 8 ulp: half of one from the file, two from our conversion, the rest for depth that a rasteriser
// interpolates across a triangle.
double storedPrecision(const ExrPart& part, const ExrChannel& depth) {
  if (depth.type == PixelType::half) return 0x1p-10;
  return part.compression == "pxr24" ? 0x1p-14 : 0x1p-20;
}

// The depth than which one in so many finite pixels is nearer.
std::optional<double> depthBehind(const Image<float>& viewZ, std::size_t oneIn) {
  std::vector<float> finite;
  for (std::size_t i = 0; i < viewZ.size(); ++i)
    if (std::isfinite(viewZ[i])) finite.push_back(viewZ[i]);
  if (finite.empty()) return std::nullopt;
  const auto chosen = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / oneIn);
  std::nth_element(finite.begin(), chosen, finite.end());
  return static_cast<double>(*chosen);
}

// A step of the stored number near 1, relative to the depth that it moves. Of window depth that step grows with
// distance, z = n f / (f - d (f - n)) and so dz / z = z (1/n - 1/f) dd, and is taken at the median. Where it is a
// length, it counts most for what is near: there one pixel in twenty is nearer than where it is taken.
double stepPrecision(const Image<float>& viewZ, const DepthConverter& convert, PixelType type) {
  if (convert.stretch(1.0) == 0.0) return 0.0;
  const bool isLength = convert.stretch(2.0) < convert.stretch(1.0);
  const std::optional<double> z = depthBehind(viewZ, isLength ? 20 : 2);
  const double step = type == PixelType::half ? 0x1p-10 : 0x1p-22;  // twice half an ulp at 1, and as much again
  return z ? step * convert.stretch(*z) : 0.0;
}

// The file's matrices are floats: their camera stands and looks only as exactly as floats of its distance from the
// origin say, which is compared with the median depth.
//   stored  what the depth is allowed in any case
double placePrecision(const Image<float>& viewZ, const std::optional<Camera>& camera, double stored) {
  if (!camera) return 0.0;
  const double lost = 0x1p-23 * glm::length(glm::dvec3(camera->viewFromWorld[3]));
  float nearest = kNothing;
  for (std::size_t i = 0; i < viewZ.size(); ++i) nearest = std::min(nearest, viewZ[i]);
  if (!std::isfinite(nearest) || lost <= stored * static_cast<double>(nearest)) return 0.0;  // no need of the median
  return lost / *depthBehind(viewZ, 2);
}

// Where nobody said what the numbers mean, the numbers have a say.
struct Reader {
  const ExrPart& part;
  const ExrChannel& depth;
  const Producer* producer;
  const Camera* camera;
  OpaqueFile& file;
  DepthEvidence evidence;

  std::string place() const { return fmt::format("{}: depth {}", file.document.path, depth.name); }
  std::string writer() const { return producer ? producer->title : "its writer"; }
  void note(const std::string& sentence) const { file.notes.push_back("depth " + depth.name + " " + sentence); }

  DepthKind settle(const DepthKind& asked) const {
    if (evidence.negative > 0 && evidence.positive == 0) return belowZero(asked);
    const bool ramp = evidence.positive > 0 && evidence.negative == 0 && evidence.most <= 1.0;
    if (ramp && producer && producer->mayBeRamp)
      throw MeaningError(
          fmt::format("{} lies within 0 to 1, {:.6g} to {:.6g}: {} may have normalised it, expected --depth-kind "
                      "normalised:NEAR:FAR[:inverted] with its limits, or another --depth-kind if it is none",
                      place(), evidence.least, evidence.most, writer()));
    if (asked.meaning == DepthMeaning::evidence) return byPlanes(asked);
    if (ramp && asked.meaning == DepthMeaning::planar)
      note(
          fmt::format("lies within 0 to 1, {:.6g} to {:.6g}, and is read as metres of {:g}: if it is normalised, give "
                      "--depth-kind normalised:NEAR:FAR[:inverted]",
                      evidence.least, evidence.most, file.metresPerUnit));
    for (const DepthMeaning other : DepthEvidence::kReadings)
      if (other != asked.meaning && asked.meaning <= DepthMeaning::inverse && speaksFor(evidence, other, asked.meaning))
        note(fmt::format("is read as {}, but {}: --depth-kind {}?{}", depthKindWords(asked),
                         evidenceText(evidence, other, asked.meaning), depthKindText({other}), unlessParallel(other)));
    if (!producer && asked.meaning == DepthMeaning::planar) noteUntold();
    return asked;
  }
  // Noise and curved things hide that depth is measured along rays.
  void noteUntold() const {
    const bool rays = camera && !camera->orthographic && evidence.positive > 0;
    if (rays && !speaksFor(evidence, DepthMeaning::planar, DepthMeaning::ray) &&
        !speaksFor(evidence, DepthMeaning::ray, DepthMeaning::planar))
      note(
          "is read as planar depth, which the planes of the picture do not tell from distance along the ray: if it is "
          "that, give --depth-kind ray");
  }
  // All numbers are below 0: minus planar depth, unless the planes fit minus another reading.
  DepthKind belowZero(const DepthKind& asked) const {
    DepthKind kind{DepthMeaning::negative};
    for (const DepthMeaning other : {DepthMeaning::ray, DepthMeaning::inverse}) {
      if (!speaksFor(evidence, other, DepthMeaning::planar)) continue;
      const DepthKind minus{.meaning = other, .negated = true};
      if (asked.meaning != DepthMeaning::evidence || !asked.mayBe(other))
        throw MeaningError(fmt::format(
            "{} is negative, {:.6g} to {:.6g}, and {}: expected --depth-kind {}, or negative", place(), evidence.least,
            evidence.most, evidenceText(evidence, other, DepthMeaning::planar), depthKindText(minus)));
      kind = minus;
    }
    if (kind.meaning == DepthMeaning::negative && asked.mayBe(DepthMeaning::inverse) &&
        !speaksFor(evidence, DepthMeaning::planar, DepthMeaning::inverse))
      throw MeaningError(
          fmt::format("{} is negative, {:.6g} to {:.6g}, and {} may have written minus depth or -1/z: the planes of "
                      "the picture do not tell, expected --depth-kind negative or inverse:negative",
                      place(), evidence.least, evidence.most, writer()));
    note(fmt::format("is negative, {:.6g} to {:.6g}: read as {}; --depth-kind says otherwise", evidence.least,
                     evidence.most, kind.negated ? depthKindWords(kind) : "minus planar depth"));
    return kind;
  }
  // Planar depth of an orthographic camera looks like 1/z of another one.
  std::string unlessParallel(DepthMeaning suggested) const {
    return !camera && suggested == DepthMeaning::inverse
               ? " Not if its camera, which is not known here, is orthographic"
               : "";
  }
  DepthKind byPlanes(const DepthKind& asked) const {
    const std::optional<DepthMeaning> meaning = spokenFor(evidence, asked);
    if (!meaning)
      throw MeaningError(
          fmt::format("{} may be {}, and the planes of the picture do not tell{}: expected one of them "
                      "as --depth-kind",
                      place(), depthKindText(asked), camera ? "" : " without a camera"));
    note(fmt::format("is {}: the planes of the picture fit no other reading", depthKindWords({*meaning})));
    return {*meaning};
  }
};

void noteOddities(const ExrChannel& depth, int firstX, int firstY, OpaqueFile& file) {
  const GBuffer& gbuffer = file.gbuffer;
  if (file.choice.nonFiniteDepth > 0)
    file.notes.push_back(fmt::format("depth {}: {} pixels are not numbers, first at ({}, {}): taken as nothing hit",
                                     depth.name, file.choice.nonFiniteDepth, gbuffer.data.x0 + firstX,
                                     gbuffer.data.y0 + firstY));
  if (depth.type == PixelType::half)
    file.notes.push_back(fmt::format(
        "depth {} is half: surfaces closer than 1/1000 of their distance cannot be told apart", depth.name));
  if (file.choice.farPixels == gbuffer.viewZ.size())
    file.notes.push_back(fmt::format("depth {}: nothing was hit in any pixel", depth.name));
}

}  // namespace

void convertDepth(const ExrPart& part, const ExrChannel& depth, const DepthKind& asked, bool isAsked,
                  const Producer* producer, std::optional<double> far, const Camera* camera, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  const bool left = !isAsked || asked.meaning == DepthMeaning::evidence;
  const DepthKind kind =
      left ? Reader{part, depth, producer, camera, file, depthEvidence(part, depth, camera)}.settle(asked) : asked;
  const DepthConverter convert(kind, depth.type, far, file.metresPerUnit, camera, gbuffer.display,
                               fmt::format("{}: depth {}", file.document.path, depth.name));

  file.choice.depthKind = depthKindText(kind);
  file.choice.farValue = convert.far();
  gbuffer.viewZ = Image<float>(gbuffer.data.width(), gbuffer.data.height(), kNothing);
  int firstX = 0, firstY = 0;
  bool any = false;
  visitPixels(depth, part.data, gbuffer.data, [&](int x, int y, float value) {
    if (std::isnan(value) || value == -kNothing) {
      if (file.choice.nonFiniteDepth++ == 0) firstX = x, firstY = y;
    }
    const double z = convert(static_cast<double>(value), gbuffer.data.x0 + x + 0.5, gbuffer.data.y0 + y + 0.5);
    // A distance beyond float is nothing; one below its smallest normal number would be flushed to 0 elsewhere.
    gbuffer.viewZ.at(x, y) = z > 0.0 ? std::max(static_cast<float>(z), std::numeric_limits<float>::min()) : kNothing;
    if (!std::isfinite(gbuffer.viewZ.at(x, y))) return;
    const auto stored = static_cast<double>(value);
    file.choice.least = any ? std::min(file.choice.least, stored) : stored;
    file.choice.most = any ? std::max(file.choice.most, stored) : stored;
    any = true;
  });
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i)
    if (!std::isfinite(gbuffer.viewZ[i])) ++file.choice.farPixels;
  const double stored = storedPrecision(part, depth);
  gbuffer.depthPrecision = static_cast<float>(std::max({stored, stepPrecision(gbuffer.viewZ, convert, depth.type),
                                                        placePrecision(gbuffer.viewZ, gbuffer.camera, stored)}));
  noteOddities(depth, firstX, firstY, file);
}

}  // namespace pellucid
