// Deep samples of one pixel made tidy: split where they overlap, merged where they coincide, in depth order. Double
// precision. Rules of OpenEXR's "Interpreting Deep Pixels".
#pragma once
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace pellucid {

// zBack <= z: a point at z. Else a volume of even density over [z, zBack].
struct DeepSample {
  double z = 0, zBack = 0;  // any unit, finite
  glm::dvec3 light{0.0};    // premultiplied
  glm::dvec4 opacity{0.0};  // of R, G, B, and the plain alpha; [0,1] each
  bool isVolume() const { return zBack > z; }
};

// The part of a volume between its ends: x in [0,1] of its length. Opacity becomes 1 - (1 - a)^x, light scales with it.
DeepSample partOfVolume(const DeepSample& sample, double from, double to);

// Calls visit(piece) front to back; pieces neither overlap nor coincide. A point comes before the volume that begins at
// its depth. Coincident samples: optical depths add, each keeps its share of the light; opaque ones hide the others
// and average among themselves. The order of `samples`, which are sorted, does not matter.
//   cuts  depths, ascending, at which volumes are to be split besides
void visitTidy(std::vector<DeepSample>& samples, const std::vector<double>& cuts,
               const std::function<void(const DeepSample&)>& visit);

// Front-to-back over of all samples: light, opacity, and z of the nearest.
struct DeepFlat {
  glm::dvec3 light{0.0};
  glm::dvec4 opacity{0.0};
};
DeepFlat flattenSamples(std::vector<DeepSample>& samples);

}  // namespace pellucid
