#include "composite/tolerance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "composite/denormals.h"
#include "composite/gather.h"
#include "composite/over.h"

namespace pellucid {
namespace {

// Roundings of one value besides the mean of N passes, which rounds N times: those of a veil, of its sums in double
// precision, and of the picture.
constexpr double kOtherRoundings = 16.0, kRounding = 0x1p-23;

float roundedUp(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}
float roundedDown(double value) {
  return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity());
}

// One pixel of one pass, without its layers.
struct Sample {
  glm::vec4 solid;
  glm::dvec3 behind{0.0};  // the solid, or else the background; 0 where that is looked up elsewhere
  // Whether the truth is known to be no less than what its layers and what is behind give. Where the background is
  // negative it is not: it may show in passes without layers, where nothing is booked.
  glm::bvec3 known{false};
  bool hasSolid() const { return std::isfinite(solid.a); }
};

glm::dvec3 leastOf(const Sample& sample, const glm::dvec3& light, const glm::dvec3& beta) {
  glm::dvec3 least(PromisedError::kUnknown);
  for (int c = 0; c < 3; ++c)
    if (sample.known[c]) least[c] = light[c] + beta[c] * sample.behind[c];
  return least;
}

// The weighted mean of a pixel's layers, and how far from the truth it may be.
struct Estimate {
  LayerMix mix;
  glm::dvec3 bound, least;
};
Estimate estimateOf(const std::vector<MethodLayer>& layers, const MethodChoice& choice, const Sample& sample,
                    double rounding) {
  Estimate estimate;
  const LightRange range = lightRangeOf(layers);
  const glm::dvec3 beta = productOfPassed(layers);
  estimate.mix = mixWeighted(layers, choice);
  estimate.mix.transmission = beta;
  estimate.least = leastOf(sample, range.least, beta);
  for (int c = 0; c < 3; ++c) {
    const double light = estimate.mix.light[c];
    const double shown = std::isfinite(sample.behind[c]) ? beta[c] * std::abs(sample.behind[c]) : 0.0;
    estimate.bound[c] = std::max(light - range.least[c], range.most[c] - light) + rounding * (std::abs(light) + shown);
  }
  if (sample.hasSolid()) {
    estimate.mix.light += beta * sample.behind;
    estimate.mix.transmission = glm::dvec3(0.0);
  }
  return estimate;
}

// What the rows of a pass share.
class WithinPass {
 public:
  WithinPass(const WithinInput& input, PromisedError& promised, Veil& veil)
      : input_(input),
        promised_(promised),
        veil_(veil),
        left_(input.lists.window.x0 - input.data.x0),
        top_(input.lists.window.y0 - input.data.y0),
        uncertain_(input.lists.solid.size(), 0) {}

  void run(ToleranceCounts& counts) {
    std::atomic<std::size_t> certified{0}, recomputed{0};
    forRows([&](int y) {
      const auto [certain, others] = estimateRow(y);
      certified += certain;
      recomputed += others;
    });
    counts.certified += certified;
    counts.recomputed += recomputed;
    compositeSorted(input_.lists, input_.data, veil_, &uncertain_);
    forRows([&](int y) { bookRow(y); });
  }

 private:
  template <class Row>
  void forRows(const Row& row) const {
    tbb::parallel_for(tbb::blocked_range<int>(0, input_.lists.window.height()),
                      [&](const tbb::blocked_range<int>& rows) {
                        const FlushDenormals flush;
                        for (int y = rows.begin(); y != rows.end(); ++y) row(y);
                      });
  }
  std::size_t entryOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(input_.lists.window.width()) +
           static_cast<std::size_t>(x);
  }
  std::size_t accountOf(int x, int y) const {
    if (input_.places) return (*input_.places)[entryOf(x, y)];
    return static_cast<std::size_t>(top_ + y) * static_cast<std::size_t>(input_.data.width()) +
           static_cast<std::size_t>(left_ + x);
  }
  Sample sampleOf(int x, int y) const {
    Sample sample{input_.lists.solid.at(x, y)};
    const int px = left_ + x, py = top_ + y;
    const bool inSight = input_.background && !(input_.scatter && scattersAt(*input_.scatter, px, py));
    if (inSight) sample.behind = glm::dvec3(glm::vec3(input_.background->at(px, py)));
    const glm::dvec3 background = sample.behind;
    if (sample.hasSolid()) sample.behind = glm::dvec3(glm::vec3(sample.solid));
    for (int c = 0; c < 3; ++c) sample.known[c] = inSight && background[c] >= 0.0;
    return sample;
  }

  // How many samples of pixels are certain, and how many are to be composited exactly.
  std::pair<std::size_t, std::size_t> estimateRow(int y) {
    std::vector<MethodLayer> layers;
    std::size_t certain = 0, others = 0;
    for (int x = 0; x < input_.lists.window.width(); ++x) {
      const Sample sample = sampleOf(x, y);
      layersOf(input_.lists, entryOf(x, y), sample.solid.a, layers);
      if (layers.empty()) {  // a solid alone is exact
        uncertain_[entryOf(x, y)] = sample.hasSolid() ? 1 : 0;
        certain += sample.hasSolid() ? 1 : 0;
        continue;
      }
      Estimate estimate = estimateOf(layers, input_.choice, sample, promised_.rounding());
      if (input_.weight) estimate.bound *= static_cast<double>(input_.weight->at(left_ + x, top_ + y));
      if (!promised_.allows(accountOf(x, y), estimate.bound, estimate.least)) {
        uncertain_[entryOf(x, y)] = 1;
        ++others;
        continue;
      }
      ++certain;
      float front = sample.solid.a;
      for (const MethodLayer& layer : layers) front = std::min(front, layer.record->z);
      veil_.light.at(left_ + x, top_ + y) = glm::vec3(estimate.mix.light);
      veil_.transmission.at(left_ + x, top_ + y) = glm::vec3(estimate.mix.transmission);
      veil_.frontZ.at(left_ + x, top_ + y) = front;
      veil_.touched.at(left_ + x, top_ + y) = 1;
    }
    return {certain, others};
  }
  void bookRow(int y) {
    for (int x = 0; x < input_.lists.window.width(); ++x) {
      if (!uncertain_[entryOf(x, y)]) continue;
      const glm::dvec3 light(veil_.light.at(left_ + x, top_ + y)), passed(veil_.transmission.at(left_ + x, top_ + y));
      promised_.bookExact(accountOf(x, y), leastOf(sampleOf(x, y), light, passed));
    }
  }

  const WithinInput& input_;
  PromisedError& promised_;
  Veil& veil_;
  int left_, top_;
  std::vector<std::uint8_t> uncertain_;
};

}  // namespace

LightRange lightRangeOf(const std::vector<MethodLayer>& layers) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const glm::dvec3 beta = productOfPassed(layers);
  LightRange range{glm::dvec3(0.0), glm::dvec3(0.0)};
  for (int c = 0; c < 3; ++c) {
    // A channel that adds hides up to 1e-3 a layer, which is part of 1 - beta and not of the mean.
    double low = kAny, high = -kAny, clear = 0.0;
    bool averages = false;
    for (const MethodLayer& layer : layers) {
      const double light = layer.light[c];
      if (layer.adds(c)) {
        clear += layer.opacity[c];
        range.least[c] += std::min(beta[c] * light, light);
        range.most[c] += std::max(beta[c] * light, light);
        continue;
      }
      if (!(layer.opacity[c] > 0.0)) return {glm::dvec3(-kAny), glm::dvec3(kAny)};
      low = std::min(low, light / layer.opacity[c]);
      high = std::max(high, light / layer.opacity[c]);
      averages = true;
    }
    if (!averages) continue;
    const double hidden = 1.0 - beta[c], least = std::max(0.0, hidden - clear);
    range.least[c] += std::min(hidden * low, least * low);
    range.most[c] += std::max(hidden * high, least * high);
  }
  return range;
}

PromisedError::PromisedError(std::size_t pixels, double tolerance, int passes)
    : accounts_(pixels),
      tolerance_(tolerance),
      rounding_((static_cast<double>(passes) + kOtherRoundings) * kRounding),
      passes_(passes) {}

double PromisedError::limit(double least) const {
  return (tolerance_ - rounding_) * std::max(passes_, least);
}

bool PromisedError::allows(std::size_t pixel, const glm::dvec3& bound, const glm::dvec3& least) {
  if (pixel >= accounts_.size()) return false;
  Account& account = accounts_[pixel];
  if (account.exact) return false;
  Account next = account;
  for (int c = 0; c < 3; ++c) {
    next.spent[c] = roundedUp(static_cast<double>(account.spent[c]) + bound[c]);
    next.least[c] = roundedDown(static_cast<double>(account.least[c]) + least[c]);
    if (!(static_cast<double>(next.spent[c]) <= limit(static_cast<double>(next.least[c])))) return false;
  }
  account = next;
  return true;
}

void PromisedError::bookExact(std::size_t pixel, const glm::dvec3& truth) {
  if (pixel >= accounts_.size()) return;
  Account& account = accounts_[pixel];
  for (int c = 0; c < 3; ++c) {
    const double least = static_cast<double>(account.least[c]) + truth[c];
    account.least[c] = roundedDown(std::isnan(least) ? kUnknown : least);
  }
}

bool PromisedError::settle() {
  bool holds = true;
  largest_ = 0.0;
  for (Account& account : accounts_)
    for (int c = 0; c < 3; ++c) {
      const double spent = static_cast<double>(account.spent[c]);
      if (spent == 0.0) continue;
      const double most = limit(static_cast<double>(account.least[c]));
      largest_ = std::max(largest_, spent / most);
      if (spent <= most) continue;
      account.exact = true;
      holds = false;
    }
  if (holds) return true;
  for (Account& account : accounts_) account.spent = account.least = glm::vec3(0.0f);
  return false;
}

void compositeWithin(const WithinInput& input, PromisedError& promised, Veil& veil, ToleranceCounts& counts) {
  WithinPass(input, promised, veil).run(counts);
}

double brokenPart(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth, double tolerance) {
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double x = static_cast<double>(picture[i][c]), t = static_cast<double>(truth[i][c]);
      const double off = std::abs(x - t);
      if (off > 0.0 && std::isfinite(off)) largest = std::max(largest, off / (tolerance * std::max(1.0, std::abs(t))));
    }
  return largest;
}

}  // namespace pellucid
