#include "composite/deep/tidy.h"

#include <algorithm>
#include <tuple>

namespace pellucid {
namespace {

// Optical depth over opacity: its limit is 1 where there is no opacity. Light divided by opacity times depth is what
// adds up along the ray.
double depthPerOpacity(double opacity) {
  return opacity > 0.0 ? -std::log1p(-opacity) / opacity : 1.0;
}

// Adds samples that share one place; n at once, so that no order matters beyond rounding.
class Coincident {
 public:
  //   share  part of the sample's length that lies here, (0,1]
  void add(const DeepSample& sample, double share) {
    ++count_;
    only_ = &sample;
    onlyShare_ = share;
    for (int c = 0; c < 4; ++c) {
      const double opacity = sample.opacity[c];
      const double light = c < 3 ? sample.light[c] : 0.0;
      if (opacity >= 1.0) {
        ++opaque_[c];
        opaqueLight_[c] += light;
      } else {
        depth_[c] += share * -std::log1p(-opacity);
        light_[c] += share * light * depthPerOpacity(opacity);
      }
    }
  }
  DeepSample finish(double z, double zBack) const {
    DeepSample merged;
    merged.z = z;
    merged.zBack = zBack;
    if (count_ == 1 && onlyShare_ == 1.0) {
      merged.light = only_->light;
      merged.opacity = only_->opacity;
      return merged;
    }
    for (int c = 0; c < 4; ++c) {
      double light = 0.0;
      if (opaque_[c] > 0) {
        merged.opacity[c] = 1.0;
        light = opaqueLight_[c] / opaque_[c];
      } else {
        merged.opacity[c] = -std::expm1(-depth_[c]);
        light = light_[c] * (depth_[c] > 0.0 ? merged.opacity[c] / depth_[c] : 1.0);
      }
      if (c < 3) merged.light[c] = light;
    }
    return merged;
  }

 private:
  int count_ = 0;
  const DeepSample* only_ = nullptr;
  double onlyShare_ = 1.0;
  double opaque_[4] = {}, opaqueLight_[4] = {}, depth_[4] = {}, light_[4] = {};
};

// All bits, so that sums of coincident samples come in one order.
bool before(const DeepSample& a, const DeepSample& b) {
  const auto key = [](const DeepSample& s) {
    return std::make_tuple(s.z, s.isVolume() ? s.zBack : s.z, s.light.x, s.light.y, s.light.z, s.opacity.x, s.opacity.y,
                           s.opacity.z, s.opacity.w);
  };
  if (a.z != b.z) return a.z < b.z;
  return key(a) < key(b);
}

}  // namespace

DeepSample partOfVolume(const DeepSample& sample, double from, double to) {
  const double share = (to - from) / (sample.zBack - sample.z);
  if (share >= 1.0) return sample;
  Coincident alone;
  alone.add(sample, share);
  return alone.finish(from, to);
}

void visitTidy(std::vector<DeepSample>& samples, const std::vector<double>& cuts,
               const std::function<void(const DeepSample&)>& visit) {
  std::sort(samples.begin(), samples.end(), before);
  std::vector<const DeepSample*> active;  // volumes that the sweep is inside of
  std::size_t next = 0, cut = 0;
  double at = 0.0;
  while (next < samples.size() || !active.empty()) {
    if (active.empty()) at = samples[next].z;
    // Points here, all of them at once.
    Coincident points;
    bool anyPoint = false;
    while (next < samples.size() && samples[next].z == at) {
      if (samples[next].isVolume()) {
        active.push_back(&samples[next]);
      } else {
        points.add(samples[next], 1.0);
        anyPoint = true;
      }
      ++next;
    }
    if (anyPoint) visit(points.finish(at, at));
    if (active.empty()) continue;
    // The stretch to the next front, back or cut.
    double until = active[0]->zBack;
    for (const DeepSample* volume : active) until = std::min(until, volume->zBack);
    if (next < samples.size()) until = std::min(until, samples[next].z);
    while (cut < cuts.size() && cuts[cut] <= at) ++cut;
    if (cut < cuts.size()) until = std::min(until, cuts[cut]);
    Coincident stretch;
    for (const DeepSample* volume : active) {
      const bool whole = at == volume->z && until == volume->zBack;
      stretch.add(*volume, whole ? 1.0 : (until - at) / (volume->zBack - volume->z));
    }
    visit(stretch.finish(at, until));
    at = until;
    std::erase_if(active, [&](const DeepSample* volume) { return volume->zBack <= at; });
  }
}

DeepFlat flattenSamples(std::vector<DeepSample>& samples) {
  DeepFlat flat;
  glm::dvec4 left(1.0);
  visitTidy(samples, {}, [&](const DeepSample& piece) {
    flat.light += glm::dvec3(left) * piece.light;
    left *= glm::dvec4(1.0) - piece.opacity;
  });
  flat.opacity = glm::dvec4(1.0) - left;
  return flat;
}

}  // namespace pellucid
