// Which reading of a depth channel the picture itself speaks for. Seen in perspective, 1 / planar depth is linear
// across the picture of a plane; so is 1 / distance along the ray times the ray's length, and 1/z as it is stored. Seen
// by an orthographic camera, planar depth itself is linear there, and distance along the ray is the same number.
// Where all numbers are below 0, their sizes speak.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "gbuffer/depth_kind.h"

namespace pellucid {

struct DepthEvidence {
  static constexpr DepthMeaning kReadings[] = {DepthMeaning::planar, DepthMeaning::ray, DepthMeaning::inverse};
  // Patches of pixels: [a][b] of them lie on a plane when read as a, and are far from any when read as b.
  std::size_t over[3][3] = {};
  bool parallel = false;                   // the camera is orthographic: planar and ray are one reading
  std::size_t patches = 0;                 // looked at, hit in all their pixels
  double least = 0, most = 0;              // finite values that renderers do not write for nothing
  std::size_t positive = 0, negative = 0;  // pixels with such values
};

//   camera  null: rays are not considered, and it is taken to be no orthographic one
DepthEvidence depthEvidence(const ExrPart& part, const ExrChannel& depth, const Camera* camera);

// The reading among the candidates of `kind` (DepthMeaning::evidence) that the patches speak for and by far, against
// each of the others; nothing when none is.
std::optional<DepthMeaning> spokenFor(const DepthEvidence& evidence, const DepthKind& kind);
// Whether one reading is spoken for against another.
bool speaksFor(const DepthEvidence& evidence, DepthMeaning meaning, DepthMeaning against);

// "412 of 3000 patches lie on planes as ray and not as planar, 3 the other way"
std::string evidenceText(const DepthEvidence& evidence, DepthMeaning meaning, DepthMeaning against);

}  // namespace pellucid
