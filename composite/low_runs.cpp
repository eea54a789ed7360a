#include "composite/low_runs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "composite/deep/deep_opaque.h"
#include "composite/fold.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr std::size_t kMostCuts = 16;  // in fog; what is nearer together than all of these gaps is one layer in it

double meanOf(const glm::dvec3& value) {
  return (value.x + value.y + value.z) / 3.0;
}

// One after the other, from near to far.
struct Stack {
  glm::dvec3 light{0.0}, transmission{1.0};
  double opacities = 0.0, depths = 0.0;
  float nearest = kNothing;
  void add(const glm::dvec3& light_, const glm::dvec3& transmission_, float z) {
    light += transmission * light_;
    transmission *= transmission_;
    const double opacity = 1.0 - meanOf(transmission_);
    opacities += opacity;
    depths += opacity * static_cast<double>(z);
    nearest = std::min(nearest, z);
  }
  bool isEmpty() const { return nearest == kNothing; }
  float z() const { return opacities > 0.0 ? static_cast<float>(depths / opacities) : nearest; }
  shading::LowTexel texel() const {
    shading::LowTexel texel{};
    texel.z = z();
    texel.nearestZ = nearest;
    return texel;
  }
};

}  // namespace

// Sums over texels, by their shares.
struct LowRuns::Run {
  glm::dvec3 light{0.0};  // seen from before all runs
  glm::dvec3 after{0.0};  // what passes this run and those before it
  double shown = 0.0, depth = 0.0;
};

LowRuns::LowRuns(std::shared_ptr<const LowView> view, glm::dvec2 sample, const LowBetween& others)
    : view_(std::move(view)),
      sample_(sample),
      others_(others),
      layers_(view_->gbuffer.viewZ.width(), view_->gbuffer.viewZ.height()),
      texels_(layers_.width(), layers_.height()),
      shares_(*view_, sample) {}

void LowRuns::add(const FragmentLists& lists) {
  std::size_t pixel = 0;
  for (int y = lists.window.y0; y < lists.window.y1; ++y)
    for (int x = lists.window.x0; x < lists.window.x1; ++x, ++pixel) {
      std::vector<TexelLayer>& layers = layers_.at(x, y);
      const glm::vec4& solid = lists.solid[pixel];
      for (std::uint64_t k = lists.offsets[pixel]; k < lists.offsets[pixel + 1]; ++k) {
        const Fragment& fragment = lists.fragments[k];
        if (takesPart(fragment, solid))
          layers.push_back({fragment.radiance, 1.0f - fragment.coverage * (1.0f - fragment.transmission), fragment.z});
      }
      if (solid.a < kNothing) layers.push_back({glm::vec3(solid), glm::vec3(0.0f), solid.a});
    }
}

void LowRuns::finish() {
  for (int j = 0; j < layers_.height(); ++j)
    for (int i = 0; i < layers_.width(); ++i) {
      Stack all;
      for (const TexelLayer& layer : layers_.at(i, j)) all.add(layer.light, layer.transmission, layer.z);
      texels_.at(i, j) = all.texel();
    }
  surface_ = std::make_unique<LowSurface>(*view_, texels_, sample_);
}

void LowRuns::addTexel(const LowSurface::Pixel& pixel, int i, int j, double share, std::span<const float> depths,
                       std::vector<Run>& runs) const {
  const std::vector<TexelLayer>& layers = layers_.at(i, j);
  glm::dvec3 passed(1.0);
  std::size_t next = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Stack stack;
    for (; next < layers.size() && (k == depths.size() || layers[next].z < depths[k]); ++next)
      stack.add(layers[next].light, layers[next].transmission, layers[next].z);
    if (!stack.isEmpty()) {
      const auto before = static_cast<double>(surface_->standingBefore(pixel, i, j, stack.texel()));
      const glm::dvec3 light = before * stack.light, opacity = before * (1.0 - stack.transmission);
      const double shown = share * meanOf(passed) * (meanOf(opacity) + std::min(meanOf(light), 1.0));
      runs[k].light += share * passed * light;
      runs[k].shown += shown;
      runs[k].depth += shown * static_cast<double>(stack.z());
      passed *= 1.0 - opacity;
    }
    runs[k].after += share * passed;
  }
}

void LowRuns::addCuts(int x, int y, std::vector<float>& depths) const {
  bool thick = others_.fog;
  if (const DeepOpaque* deep = others_.deep) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(deep->data.width()) + static_cast<std::size_t>(x);
    for (std::uint64_t k = deep->offsets[pixel]; k < deep->offsets[pixel + 1]; ++k) {
      depths.push_back(deep->samples[k].z);
      thick = thick || deep->samples[k].reach > 0.0f;
    }
  }
  if (thick) addGaps(x, y, depths);
}

// The middles of the widest gaps between the layers of the texel that counts most.
void LowRuns::addGaps(int x, int y, std::vector<float>& depths) const {
  const std::vector<TexelLayer>* nearest = nullptr;
  float largest = 0.0f;
  shares_.around(x, y, [&](int i, int j, float share) {
    if (share > largest) nearest = &layers_.at(i, j);
    largest = std::max(largest, share);
  });
  if (!nearest) return;
  std::vector<std::pair<float, float>> gaps;  // how wide, and its middle
  for (std::size_t k = 1; k < nearest->size(); ++k) {
    const float from = (*nearest)[k - 1].z, to = (*nearest)[k].z;
    if (to > from) gaps.emplace_back(to - from, 0.5f * from + 0.5f * to);
  }
  const std::size_t kept = std::min(gaps.size(), kMostCuts);
  std::partial_sort(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(kept), gaps.end(), std::greater<>());
  for (std::size_t k = 0; k < kept; ++k) depths.push_back(gaps[k].second);
}

void LowRuns::between(int x, int y, std::span<const float> depths, std::uint32_t identity,
                      std::vector<Fragment>& found) const {
  thread_local std::vector<Run> runs;
  runs.assign(depths.size() + 1, Run());
  const LowSurface::Pixel pixel = surface_->pixel(x, y);
  double shares = 0.0;
  shares_.around(x, y, [&](int i, int j, float share) {
    shares += static_cast<double>(share);
    addTexel(pixel, i, j, static_cast<double>(share), depths, runs);
  });
  if (!(shares > 0.0)) return;
  glm::dvec3 passed(1.0);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Run& run = runs[k];
    const glm::dvec3 light = run.light / shares, after = run.after / shares;
    if (run.shown > 0.0) {
      Fragment fragment{};
      fragment.coverage = 1.0f;
      for (int c = 0; c < 3; ++c) {
        const bool sees = passed[c] > 0.0;
        fragment.radiance[c] = static_cast<float>(sees ? light[c] / passed[c] : 0.0);
        fragment.transmission[c] = static_cast<float>(sees ? std::min(after[c] / passed[c], 1.0) : 1.0);
      }
      fragment.z = static_cast<float>(run.depth / run.shown);
      if (k > 0) fragment.z = std::max(fragment.z, std::nextafter(depths[k - 1], kNothing));
      if (k < depths.size()) fragment.z = std::min(fragment.z, std::nextafter(depths[k], 0.0f));
      fragment.identity = identity + static_cast<std::uint32_t>(k);  // coins of stochastic masks are their own
      // What hides all is still a layer here, not the pixel's solid.
      if (shading::isSolid(fragment.coverage, fragment.transmission)) fragment.coverage = std::nextafter(1.0f, 0.0f);
      found.push_back(fragment);
    }
    passed = after;
  }
}

}  // namespace pellucid
