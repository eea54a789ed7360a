// Haar coefficients, rank R, of the absorbance in front of a depth, over the pixel's own depth range. Three curves, one
// per channel. Aizenshtein, Smal, McGuire: Wavelet Transparency (2022)
#include <algorithm>
#include <cmath>

#include "composite/methods/method.h"

namespace pellucid {
namespace {

// coefficient[0] is the mean; level p holds 2^p of them from index 2^p on.
class HaarCurve {
 public:
  explicit HaarCurve(int rank) : rank_(rank), coefficients_(std::size_t{2} << rank, glm::dvec3(0.0)) {}

  // A step of this height at d, [0,1).
  void addStep(double d, const glm::dvec3& height) {
    coefficients_[0] += height * (1.0 - d);
    for (int p = 0; p <= rank_; ++p) {
      const double cells = std::ldexp(1.0, p);
      const double k = std::floor(d * cells), r = d - k / cells;
      const bool leftHalf = r < 0.5 / cells;
      coefficients_[indexOf(p, k)] -= height * (std::sqrt(cells) * (leftHalf ? r : 1.0 / cells - r));
    }
  }
  // Between the means of the finest cells at and before d.
  glm::dvec3 at(double d) const {
    const double cells = std::ldexp(1.0, rank_ + 1);
    const double j = std::min(std::floor(d * cells), cells - 1.0);
    const double fraction = d * cells - j;
    const glm::dvec3 here = cellMean(j), before = j > 0.0 ? cellMean(j - 1.0) : glm::dvec3(0.0);
    return before + fraction * (here - before);
  }

 private:
  static std::size_t indexOf(int p, double k) { return (std::size_t{1} << p) + static_cast<std::size_t>(k); }
  glm::dvec3 cellMean(double j) const {
    const double cells = std::ldexp(1.0, rank_ + 1);
    const double middle = (j + 0.5) / cells;
    glm::dvec3 mean = coefficients_[0];
    for (int p = 0; p <= rank_; ++p) {
      const double levelCells = std::ldexp(1.0, p);
      const double k = std::floor(middle * levelCells);
      const double sign = middle - k / levelCells < 0.5 / levelCells ? 1.0 : -1.0;
      mean += coefficients_[indexOf(p, k)] * (sign * std::sqrt(levelCells));
    }
    return mean;
  }
  int rank_;
  std::vector<glm::dvec3> coefficients_;
};

}  // namespace

LayerMix mixWavelet(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  double low = layers[0].z, high = low;
  for (const MethodLayer& layer : layers) {
    low = std::min(low, layer.z);
    high = std::max(high, layer.z);
  }
  const double cells = std::ldexp(1.0, choice.order + 1);
  const auto place = [&](double z) { return high > low ? (z - low) / (high - low) * ((cells - 1.0) / cells) : 0.0; };
  HaarCurve curve(choice.order);
  for (const MethodLayer& layer : layers) curve.addStep(place(layer.z), absorbanceOf(layer.opacity));
  std::vector<glm::dvec3> before(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    // Without its own step, or a layer would shade itself.
    const double d = place(layers[i].z);
    HaarCurve own(choice.order);
    own.addStep(d, absorbanceOf(layers[i].opacity));
    before[i] = glm::exp(-glm::max(curve.at(d) - own.at(d), glm::dvec3(0.0)));
  }
  return mixByTransmittance(layers, before);
}

}  // namespace pellucid
