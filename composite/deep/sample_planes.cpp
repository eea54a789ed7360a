#include "composite/deep/sample_planes.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "gbuffer/depth_plane.h"

namespace pellucid {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What is linear on a plane, of samples of a deep picture.
class LinearDepth {
 public:
  LinearDepth(const DeepOpaque& opaque, bool orthographic) : opaque_(opaque), orthographic_(orthographic) {}

  double of(const OpaqueSample& sample) const {
    const auto z = static_cast<double>(sample.z);
    return orthographic_ ? z : 1.0 / z;
  }
  // Along one axis through a sample: of each neighbouring pixel the sample nearest to where those before it lead.
  PlaneValues through(int x, int y, int dx, int dy, const OpaqueSample& sample) const {
    PlaneValues values;
    values.fill(kNone);
    values[kPlaneReach] = 1.0;
    const double scale = 1.0 / of(sample);
    for (const int side : {-1, 1}) {
      double last = 1.0, step = 0.0;
      for (int k = 1; k <= kPlaneReach; ++k) {
        const double next = nearest(x + side * k * dx, y + side * k * dy, last + step, scale);
        if (std::isnan(next)) break;
        values[static_cast<std::size_t>(kPlaneReach + side * k)] = next;
        step = next - last;
        last = next;
      }
    }
    return values;
  }

 private:
  double nearest(int x, int y, double expected, double scale) const {
    if (x < 0 || y < 0 || x >= opaque_.data.width() || y >= opaque_.data.height()) return kNone;
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(opaque_.data.width()) + static_cast<std::size_t>(x);
    double found = kNone;
    for (std::uint64_t k = opaque_.offsets[pixel]; k < opaque_.offsets[pixel + 1]; ++k) {
      const double value = of(opaque_.samples[k]) * scale;
      if (!(std::abs(value - expected) >= std::abs(found - expected))) found = value;
    }
    return found;
  }

  const DeepOpaque& opaque_;
  bool orthographic_;
};

}  // namespace

SamplePlanes::SamplePlanes(const DeepOpaque& opaque, bool orthographic)
    : centres_(opaque), orthographic_(orthographic), slopes_(opaque.samples.size(), glm::vec2(0.0f)) {
  const LinearDepth linear(opaque, orthographic);
  const int width = opaque.data.width();
  tbb::parallel_for(0, opaque.data.height(), [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      for (std::uint64_t k = opaque.offsets[pixel]; k < opaque.offsets[pixel + 1]; ++k)
        for (const int axis : {0, 1}) {
          const PlaneValues values = linear.through(x, y, 1 - axis, axis, opaque.samples[k]);
          const std::optional<double> slope = slopeAlong(values, static_cast<double>(opaque.depthPrecision));
          slopes_[k][axis] = static_cast<float>(slope.value_or(0.0));
        }
    }
  });
}

void SamplePlanes::moveTo(glm::dvec2 sample, DeepOpaque& moved) const {
  const glm::dvec2 offset = sample - 0.5;
  tbb::parallel_for(std::size_t{0}, centres_.offsets.size() - 1, [&](std::size_t pixel) {
    const std::uint64_t first = centres_.offsets[pixel], last = centres_.offsets[pixel + 1];
    for (std::uint64_t k = first; k < last; ++k) {
      const DepthPlane plane{static_cast<double>(centres_.samples[k].z), static_cast<double>(slopes_[k].x),
                             static_cast<double>(slopes_[k].y), orthographic_};
      moved.samples[k].z = static_cast<float>(plane.z(offset.x, offset.y));
    }
    if (std::isfinite(centres_.farthest[pixel]) && last > first)
      moved.farthest[pixel] = moved.samples[last - 1].z + moved.samples[last - 1].reach;
  });
}

}  // namespace pellucid
