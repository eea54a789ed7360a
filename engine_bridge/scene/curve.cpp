#include "engine_bridge/scene/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine_bridge/scene/accessor.h"

namespace pellucid::gltf {

namespace {

constexpr double kShortest = 1e-30;  // quaternion

double lengthOf(const std::vector<double>& q) {
  return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

std::vector<double> unit(std::vector<double> q) {
  const double length = lengthOf(q);
  // A spline may pass through zero, where it has no direction: no rotation then.
  if (!(length > kShortest)) return {0.0, 0.0, 0.0, 1.0};
  for (double& c : q) c /= length;
  return q;
}

std::vector<double> mixed(const std::vector<double>& a, double partOfA, const std::vector<double>& b, double partOfB) {
  std::vector<double> result(a.size());
  for (std::size_t c = 0; c < a.size(); ++c) result[c] = partOfA * a[c] + partOfB * b[c];
  return result;
}

// sin(part * angle) / sin(angle), down to no angle at all.
double portion(double part, double angle) {
  return angle > 1e-8 ? std::sin(part * angle) / std::sin(angle) : part;
}

// Spherical linear interpolation the shorter way round (glTF 2.0, C.3).
std::vector<double> slerp(const std::vector<double>& from, std::vector<double> to, double t) {
  double dot = 0.0, apart = 0.0, together = 0.0;
  for (std::size_t c = 0; c < 4; ++c) dot += from[c] * to[c];
  if (dot < 0.0)
    for (double& c : to) c = -c;
  for (std::size_t c = 0; c < 4; ++c) {
    apart += (to[c] - from[c]) * (to[c] - from[c]);
    together += (to[c] + from[c]) * (to[c] + from[c]);
  }
  // The cosine alone would not tell small angles.
  const double angle = 2.0 * std::atan2(std::sqrt(apart), std::sqrt(together));
  return unit(mixed(from, portion(1.0 - t, angle), to, portion(t, angle)));
}

Interpolation interpolationOf(const JsonView& sampler) {
  const std::string name = sampler.string("interpolation", "LINEAR");
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubicSpline;
  sampler.at("interpolation").refuse(fmt::format("is {}; expected STEP, LINEAR or CUBICSPLINE", name));
}

void expectFinite(const JsonView& reference, const std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) reference.refuse(fmt::format("hold a value that is not finite, number {}", i));
}

}  // namespace

const float* Curve::key(std::size_t index) const {
  const bool spline = interpolation == Interpolation::cubicSpline;
  return values.data() + index * width * (spline ? 3 : 1);
}

std::vector<double> Curve::value(std::size_t index) const {
  const float* from = key(index) + (interpolation == Interpolation::cubicSpline ? width : 0);
  std::vector<double> result(width);
  for (std::size_t c = 0; c < width; ++c) result[c] = static_cast<double>(from[c]);
  return kind == CurveKind::rotation && interpolation != Interpolation::cubicSpline ? unit(std::move(result)) : result;
}

std::vector<double> Curve::at(double time) const {
  const auto after = std::upper_bound(seconds.begin(), seconds.end(), time,
                                      [](double t, float key) { return t < static_cast<double>(key); });
  const auto next = static_cast<std::size_t>(after - seconds.begin());
  const bool between = next > 0 && next < seconds.size();
  const std::size_t last = next > 0 ? next - 1 : 0;
  std::vector<double> held = value(last);
  if (!between || interpolation == Interpolation::step)
    return kind == CurveKind::rotation ? unit(std::move(held)) : held;
  const auto begin = static_cast<double>(seconds[last]);
  const double span = static_cast<double>(seconds[next]) - begin;  // > 0: keys of one time have been stepped over
  const double t = (time - begin) / span;
  const std::vector<double> to = value(next);
  if (interpolation == Interpolation::linear)
    return kind == CurveKind::rotation ? slerp(held, to, t) : mixed(held, 1.0 - t, to, t);
  const float *out = key(last) + 2 * width, *in = key(next);
  std::vector<double> result(width);
  for (std::size_t c = 0; c < width; ++c)
    result[c] = (2.0 * t * t * t - 3.0 * t * t + 1.0) * held[c] +
                span * (t * t * t - 2.0 * t * t + t) * static_cast<double>(out[c]) +
                (3.0 * t * t - 2.0 * t * t * t) * to[c] + span * (t * t * t - t * t) * static_cast<double>(in[c]);
  return kind == CurveKind::rotation ? unit(std::move(result)) : result;
}

Curve readCurve(GltfFile& file, const JsonView& sampler, const CurveShape& shape) {
  Curve curve;
  curve.kind = shape.kind;
  curve.interpolation = interpolationOf(sampler);
  const JsonView input = sampler.at("input"), output = sampler.at("output");
  curve.seconds = readElements(file, input, {1}, Integers::none).values;
  expectFinite(input, curve.seconds);
  for (std::size_t k = 1; k < curve.seconds.size(); ++k)
    if (curve.seconds[k] < curve.seconds[k - 1])
      input.refuse(fmt::format("fall from {:g} s to {:g} s at key {}; expected times that rise", curve.seconds[k - 1],
                               curve.seconds[k], k));
  Elements elements =
      readElements(file, output, {1, 2, 3, 4}, shape.plainIntegers ? Integers::any : Integers::normalised);
  const std::size_t perKey = curve.interpolation == Interpolation::cubicSpline ? 3 : 1;
  const std::size_t keys = curve.seconds.size() * perKey;
  if (elements.count % keys != 0)
    output.refuse(fmt::format("have {} elements for {} keys; expected a multiple of {}", elements.count,
                              curve.seconds.size(), keys));
  curve.width = elements.width * (elements.count / keys);
  if (shape.width != 0 && curve.width != shape.width)
    output.refuse(fmt::format("have {} numbers a key; expected {}", curve.width, shape.width));
  if (elements.width > 1 && elements.count != keys)
    output.refuse(fmt::format("have {} elements for {} keys; expected {}", elements.count, curve.seconds.size(), keys));
  expectFinite(output, elements.values);
  curve.values = std::move(elements.values);
  if (curve.kind != CurveKind::rotation || perKey == 3) return curve;
  for (std::size_t k = 0; k < curve.seconds.size(); ++k) {
    const float* q = &curve.values[4 * k];
    if (!(lengthOf(std::vector<double>(q, q + 4)) > kShortest))
      output.refuse(fmt::format("have no length at key {}; expected unit quaternions", k));
  }
  return curve;
}

}  // namespace pellucid::gltf
