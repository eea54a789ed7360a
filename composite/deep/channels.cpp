#include "composite/deep/channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

class Finder {
 public:
  Finder(const ExrPart& part, DeepChannels& channels) : part_(part), channels_(channels) {}
  int optional(const std::string& name) {
    if (!part_.find(name)) return -1;
    channels_.names.push_back(name);
    return static_cast<int>(channels_.names.size()) - 1;
  }
  bool has(std::initializer_list<const char*> names) const {
    return std::all_of(names.begin(), names.end(), [&](const char* name) { return part_.find(name) != nullptr; });
  }

 private:
  const ExrPart& part_;
  DeepChannels& channels_;
};

std::string namesOf(const ExrPart& part) {
  std::vector<std::string> names;
  for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

double clampedOpacity(double value, bool& odd) {
  if (value >= 0.0 && value <= 1.0) return value;
  odd = true;
  return std::clamp(value, 0.0, 1.0);
}

}  // namespace

DeepChannels resolveDeep(const std::string& path) {
  const ExrDocument document = readExr(path);
  const auto part = std::find_if(document.parts.begin(), document.parts.end(), [](const ExrPart& p) { return p.deep; });
  if (part == document.parts.end())
    throw MeaningError(fmt::format("{}: found a flat picture ({}), expected deep samples", path,
                                   document.parts.empty() ? "" : namesOf(document.parts[0])));
  DeepChannels channels;
  channels.part = static_cast<int>(part - document.parts.begin());
  Finder find(*part, channels);
  if (!find.has({"Z", "R", "G", "B"}))
    throw MeaningError(
        fmt::format("{}: found deep channels {}, expected Z, R, G, B and an opacity", path, namesOf(*part)));
  channels.z = find.optional("Z");
  channels.zBack = find.optional("ZBack");
  channels.light = {find.optional("R"), find.optional("G"), find.optional("B")};
  channels.alpha = find.optional("A");
  channels.colouredOpacity = true;
  if (find.has({"AR", "AG", "AB"})) {
    channels.opacity = {find.optional("AR"), find.optional("AG"), find.optional("AB")};
  } else if (find.has({"RA", "GA", "BA"})) {
    channels.opacity = {find.optional("RA"), find.optional("GA"), find.optional("BA")};
  } else if (channels.alpha >= 0) {
    channels.opacity = {channels.alpha, channels.alpha, channels.alpha};
    channels.colouredOpacity = false;
  } else {
    throw MeaningError(
        fmt::format("{}: found deep channels {}, expected A, or AR, AG, AB, or RA, GA, BA", path, namesOf(*part)));
  }
  if (find.has({"oit.coverage", "oit.t.R", "oit.t.G", "oit.t.B", "oit.delta.X", "oit.delta.Y", "oit.D2"})) {
    channels.coverage = find.optional("oit.coverage");
    channels.transmission = {find.optional("oit.t.R"), find.optional("oit.t.G"), find.optional("oit.t.B")};
    channels.offset = {find.optional("oit.delta.X"), find.optional("oit.delta.Y")};
    channels.variance = find.optional("oit.D2");
  }
  return channels;
}

bool sampleAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double metresPerUnit,
              DeepSample& sample, DeepOddities& oddities) {
  const auto value = [&](int index) { return static_cast<double>(rows.channels[static_cast<std::size_t>(index)][i]); };
  sample.z = value(channels.z) * metresPerUnit;
  sample.zBack = channels.zBack >= 0 ? value(channels.zBack) * metresPerUnit : sample.z;
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

Fragment recordAt(const DeepChannels& channels, const DeepRows& rows, std::uint64_t i, double metresPerUnit) {
  const auto value = [&](int index) { return rows.channels[static_cast<std::size_t>(index)][i]; };
  Fragment fragment{};
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    fragment.radiance[c] = value(channels.light[k]);
    fragment.transmission[c] = std::clamp(value(channels.transmission[k]), 0.0f, 1.0f);
  }
  fragment.coverage = std::clamp(value(channels.coverage), 0.0f, 1.0f);
  fragment.z = static_cast<float>(static_cast<double>(value(channels.z)) * metresPerUnit);
  fragment.offset = {value(channels.offset[0]), value(channels.offset[1])};
  fragment.variance = value(channels.variance);
  return fragment;
}

}  // namespace pellucid
