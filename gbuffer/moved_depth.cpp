#include "gbuffer/moved_depth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kUncovered = 0x7fffffffu;  // behind +inf, as floats above 0 are ordered
constexpr double kSkyZ = 1e9;                      // metres: no camera moves anything there but by turning
constexpr double kSlack = 1.0 / 64.0;              // pixels that neighbours overlap by, against rounding
constexpr double kWidest = 16.0;                   // pixels: a square that becomes larger is seen edge-on

class Carrier {
 public:
  Carrier(const GBuffer& gbuffer, const Camera& taken, const Camera& from)
      : gbuffer_(gbuffer), taken_(taken), from_(from), size_(gbuffer.display.width(), gbuffer.display.height()) {
    fromTaken_ = from.viewFromWorld * glm::inverse(taken.viewFromWorld);
  }
  // Of the data window's pixel, its centre at whole numbers, to the same of the other camera, and the depth there;
  // behind that camera the depth is below 0.
  glm::dvec3 operator()(glm::dvec2 pixel, double z) const {
    const glm::dvec3 p(fromTaken_ * glm::dvec4(viewPoint(gbuffer_, taken_, pixel, z), 1.0));
    const double there = -p.z;
    const glm::dvec2 atOne = from_.orthographic ? glm::dvec2(p) : glm::dvec2(p) / there;
    const glm::dvec2 ndc = from_.focal * atOne + from_.centre;
    const glm::dvec2 display = glm::dvec2(0.5 * (ndc.x + 1.0), 0.5 * (1.0 - ndc.y)) * size_;
    const glm::dvec2 origin(gbuffer_.data.x0 - gbuffer_.display.x0 + 0.5, gbuffer_.data.y0 - gbuffer_.display.y0 + 0.5);
    return {display - origin, there};
  }

 private:
  const GBuffer& gbuffer_;
  const Camera &taken_, &from_;
  glm::dvec2 size_;
  glm::dmat4 fromTaken_{1.0};
};

// A depth that no slope, however wrong at an edge, takes far away within its own pixel.
double tame(double z, double centre) {
  return std::clamp(z, 0.5 * centre, 2.0 * centre);
}

void nearer(std::uint32_t& kept, std::uint32_t found) {
  std::atomic_ref<std::uint32_t> atomic(kept);
  std::uint32_t old = atomic.load(std::memory_order_relaxed);
  while (found < old && !atomic.compare_exchange_weak(old, found, std::memory_order_relaxed)) {
  }
}

// The square of one pixel into the samples that it covers.
void carry(const DepthPlane& plane, bool sky, glm::dvec2 pixel, const Carrier& carrier, glm::dvec2 sample,
           Image<std::uint32_t>& bits) {
  const auto zAt = [&](double x, double y) { return sky ? kSkyZ : tame(plane.z(x, y), plane.centre); };
  const auto corner = [&](double x, double y) { return carrier(pixel + glm::dvec2(x, y), zAt(x, y)); };
  const glm::dvec3 origin = corner(-0.5, -0.5), right = corner(0.5, -0.5), below = corner(-0.5, 0.5);
  const glm::dvec3 opposite = corner(0.5, 0.5);
  if (!(std::min({origin.z, right.z, below.z, opposite.z}) > 0.0)) return;
  const glm::dvec2 least =
      glm::min(glm::min(glm::dvec2(origin), glm::dvec2(right)), glm::min(glm::dvec2(below), glm::dvec2(opposite)));
  const glm::dvec2 most =
      glm::max(glm::max(glm::dvec2(origin), glm::dvec2(right)), glm::max(glm::dvec2(below), glm::dvec2(opposite)));
  if (most.x - least.x > kWidest || most.y - least.y > kWidest) return;
  const glm::dmat2 across(glm::dvec2(right - origin), glm::dvec2(below - origin));
  const double area = glm::determinant(across);
  if (!(area > 1e-9)) return;  // turned away, or edge-on
  const glm::dmat2 back = glm::inverse(across);
  const glm::dvec2 offset = sample - 0.5;
  const int x0 = std::max(static_cast<int>(std::ceil(least.x - offset.x - kSlack)), 0);
  const int y0 = std::max(static_cast<int>(std::ceil(least.y - offset.y - kSlack)), 0);
  const int x1 = std::min(static_cast<int>(std::floor(most.x - offset.x + kSlack)), bits.width() - 1);
  const int y1 = std::min(static_cast<int>(std::floor(most.y - offset.y + kSlack)), bits.height() - 1);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const glm::dvec2 in = back * (glm::dvec2(x, y) + offset - glm::dvec2(origin)) - 0.5;
      if (std::max(std::abs(in.x), std::abs(in.y)) > 0.5 + kSlack) continue;
      const double z = carrier(pixel + in, zAt(in.x, in.y)).z;
      const float found = sky ? std::numeric_limits<float>::infinity() : static_cast<float>(z);
      if (found > 0.0f) nearer(bits.at(x, y), std::bit_cast<std::uint32_t>(found));
    }
}

// The samples about a run of those that nothing landed on, along a row or a column.
struct Gap {
  int length = 0;
  std::uint32_t farther = 0u;  // of both ends; 0 where neither lies in the picture
};

// Of each line: `stride` apart lie the samples of a line, `lines` begin `step` apart.
std::vector<Gap> gapsAlong(const Image<std::uint32_t>& bits, std::size_t lines, std::size_t step, std::size_t length,
                           std::size_t stride) {
  std::vector<Gap> gaps(bits.size());
  tbb::parallel_for(std::size_t{0}, lines, [&](std::size_t line) {
    const std::size_t first = line * step;
    for (std::size_t k = 0; k < length;) {
      if (bits[first + k * stride] != kUncovered) {
        ++k;
        continue;
      }
      std::size_t end = k;
      while (end < length && bits[first + end * stride] == kUncovered) ++end;
      Gap gap{static_cast<int>(end - k), 0u};
      if (k > 0) gap.farther = bits[first + (k - 1) * stride];
      if (end < length) gap.farther = std::max(gap.farther, bits[first + end * stride]);
      for (; k < end; ++k) gaps[first + k * stride] = gap;
    }
  });
  return gaps;
}

// Samples that nothing landed on, across the gap where it is narrower: what a nearer thing has uncovered goes on as
// what lies beside it farther away.
void fill(Image<std::uint32_t>& bits) {
  bool open = false;
  for (std::size_t i = 0; i < bits.size() && !open; ++i) open = bits[i] == kUncovered;
  if (!open) return;
  const auto width = static_cast<std::size_t>(bits.width()), height = static_cast<std::size_t>(bits.height());
  const std::vector<Gap> along = gapsAlong(bits, height, width, width, 1),
                         down = gapsAlong(bits, width, 1, height, width);
  constexpr std::uint32_t kSky = 0x7f800000u;  // +inf, where nothing landed in either line
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] != kUncovered) continue;
    const Gap &a = along[i], &d = down[i];
    const bool row = d.farther == 0u || (a.farther != 0u && a.length <= d.length);
    const std::uint32_t found = row ? a.farther : d.farther;
    bits[i] = found != 0u ? found : kSky;
  }
}

}  // namespace

void depthFrom(const DepthPlanes& planes, const GBuffer& gbuffer, const Camera& taken, const Camera& from,
               glm::dvec2 sample, Image<float>& viewZ, Image<std::uint8_t>* unseen) {
  const Carrier carrier(gbuffer, taken, from);
  const int width = gbuffer.data.width(), height = gbuffer.data.height();
  Image<std::uint32_t> bits(width, height, kUncovered);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const bool sky = !std::isfinite(gbuffer.viewZ.at(x, y));
      carry(sky ? DepthPlane{} : planes.at(x, y), sky, glm::dvec2(x, y), carrier, sample, bits);
    }
  });
  if (unseen) {
    *unseen = Image<std::uint8_t>(width, height, 0);
    for (std::size_t i = 0; i < bits.size(); ++i) (*unseen)[i] = bits[i] == kUncovered ? 1 : 0;
  }
  fill(bits);
  for (std::size_t i = 0; i < bits.size(); ++i) viewZ[i] = std::bit_cast<float>(bits[i]);
}

}  // namespace pellucid
