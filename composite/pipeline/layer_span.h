// How far transparent things reach from the camera: of whole scenes and files, not of what a frame shows.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>

#include "composite/deep/deep_source.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid {

// Planar metres; may begin behind the eye.
struct DepthSpan {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool empty() const { return !(low <= high); }
  void add(double z) {
    low = std::min(low, z);
    high = std::max(high, z);
  }
  void add(const DepthSpan& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

DepthSpan layerSpanOf(const Scene& scene, const Camera& camera);
// Of the samples in front of the picture.
DepthSpan layerSpanOf(const std::unique_ptr<DeepSource>& file, const GBuffer& gbuffer);

}  // namespace pellucid
