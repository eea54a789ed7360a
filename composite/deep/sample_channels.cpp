#include "composite/deep/sample_channels.h"

#include <algorithm>
#include <cmath>

#include "shaders/shading.h"

namespace pellucid {
namespace {

double clampedOpacity(double value, bool& odd) {
  if (value >= 0.0 && value <= 1.0) return value;
  odd = true;
  return std::clamp(value, 0.0, 1.0);
}

}  // namespace

bool sampleAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, const DepthConverter& depth, int x,
              int y, DeepSample& sample, DeepOddities& oddities) {
  const auto value = [&](int index) { return static_cast<double>(rows.channels[static_cast<std::size_t>(index)][i]); };
  const auto depthOf = [&](int index) { return std::min(depth.distance(value(index), x + 0.5, y + 0.5), kFarthest); };
  sample.z = depthOf(channels.z);
  sample.zBack = channels.zBack >= 0 ? depthOf(channels.zBack) : sample.z;
  bool odd = false;
  double sum = sample.z + sample.zBack;
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    sample.light[c] = value(channels.light[k]);
    sample.opacity[c] = value(channels.opacity[k]);
    sum += sample.light[c] + sample.opacity[c];
  }
  const double mean = (sample.opacity.x + sample.opacity.y + sample.opacity.z) / 3.0;
  sample.opacity.w = channels.alpha >= 0 ? value(channels.alpha) : mean;
  if (!std::isfinite(sum + sample.opacity.w)) {
    ++oddities.notFinite;
    return false;
  }
  for (int c = 0; c < 4; ++c) sample.opacity[c] = clampedOpacity(sample.opacity[c], odd);
  oddities.outOfRange += odd;
  if (sample.zBack < sample.z) sample.zBack = sample.z;
  return true;
}

Fragment fragmentAt(const DeepSample& sample, double z) {
  const double coverage = std::max({sample.opacity.x, sample.opacity.y, sample.opacity.z});
  Fragment fragment{};
  fragment.radiance = glm::vec3(sample.light);
  fragment.coverage = static_cast<float>(coverage);
  fragment.z = static_cast<float>(z);
  if (coverage > 0.0)
    for (int c = 0; c < 3; ++c) fragment.transmission[c] = static_cast<float>(1.0 - sample.opacity[c] / coverage);
  return fragment;
}

const std::vector<std::string>& recordChannels() {
  static const std::vector<std::string> names{
      "R",       "G",       "B",       "A",           "AR",          "AG",    "AB", "Z", "ZBack", "oit.coverage",
      "oit.t.R", "oit.t.G", "oit.t.B", "oit.delta.X", "oit.delta.Y", "oit.D2"};
  return names;
}

std::array<float, 16> recordValues(const Fragment& fragment) {
  const glm::vec3 opacity = shading::opacityOf(fragment.coverage, fragment.transmission);
  return {fragment.radiance.r,
          fragment.radiance.g,
          fragment.radiance.b,
          shading::meanOf(opacity),
          opacity.r,
          opacity.g,
          opacity.b,
          fragment.z,
          fragment.z,
          fragment.coverage,
          fragment.transmission.r,
          fragment.transmission.g,
          fragment.transmission.b,
          fragment.offset.x,
          fragment.offset.y,
          fragment.variance};
}

Fragment recordAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double z) {
  const auto value = [&](int index) { return rows.channels[static_cast<std::size_t>(index)][i]; };
  Fragment fragment{};
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    fragment.radiance[c] = value(channels.light[k]);
    fragment.transmission[c] = std::clamp(value(channels.transmission[k]), 0.0f, 1.0f);
  }
  fragment.coverage = std::clamp(value(channels.coverage), 0.0f, 1.0f);
  fragment.z = static_cast<float>(z);
  fragment.offset = {value(channels.offset[0]), value(channels.offset[1])};
  fragment.variance = value(channels.variance);
  return fragment;
}

}  // namespace pellucid
