// An animation sampler: keys over time, and the values between them. glTF 2.0, appendix C
#pragma once
#include <cstddef>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

enum class Interpolation { step, linear, cubicSpline };
// Rotations are interpolated along the shorter great circle and come out as unit quaternions (x y z w).
enum class CurveKind { plain, rotation };

struct Curve {
  Interpolation interpolation = Interpolation::linear;
  CurveKind kind = CurveKind::plain;
  std::size_t width = 1;       // numbers of one value
  std::vector<float> seconds;  // finite, never decreasing, at least one
  // Finite. By key: `width` numbers; of cubicSpline three times as many: the tangent in, the value, the tangent out.
  std::vector<float> values;

  // `width` numbers, in double precision. Before the first key it is the first value, after the last the last. Where
  // keys share a time, the last of them counts from there on.
  std::vector<double> at(double time) const;

 private:
  const float* key(std::size_t index) const;
  std::vector<double> value(std::size_t index) const;
};

// What a channel's values must be.
struct CurveShape {
  CurveKind kind = CurveKind::plain;
  std::size_t width = 0;  // 0: as many as the accessors make
  bool plainIntegers = false;
};

// Throws InputError naming the sampler: an unknown interpolation, times that are not finite or that decrease, values
// that are not finite, counts that do not match, a rotation without length.
//   sampler  animations[i].samplers[j]
Curve readCurve(GltfFile& file, const JsonView& sampler, const CurveShape& shape);

}  // namespace pellucid::gltf
