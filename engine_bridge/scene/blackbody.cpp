#include "engine_bridge/scene/blackbody.h"

#include <array>
#include <cmath>

namespace pellucid {
namespace {

constexpr int kFirst = 360, kStep = 5, kSamples = 95;  // nanometres, to 830

double lobe(double nanometres, double centre, double below, double above) {
  const double off = (nanometres - centre) / (nanometres < centre ? below : above);
  return std::exp(-0.5 * off * off);
}

// Colour matching functions of the CIE 1931 observer as sums of lobes. Wyman, Sloan, Shirley: Simple Analytic
// Approximations to the CIE XYZ Color Matching Functions, JCGT 2(2), 2013
glm::dvec3 matchingAt(double nanometres) {
  return {1.056 * lobe(nanometres, 599.8, 37.9, 31.0) + 0.362 * lobe(nanometres, 442.0, 16.0, 26.7) -
              0.065 * lobe(nanometres, 501.1, 20.4, 26.2),
          0.821 * lobe(nanometres, 568.8, 46.9, 40.5) + 0.286 * lobe(nanometres, 530.9, 16.3, 31.1),
          1.217 * lobe(nanometres, 437.0, 11.8, 36.0) + 0.681 * lobe(nanometres, 459.0, 26.0, 13.8)};
}

// What a wavelength's radiance is worth in linear Rec.709. The matrix is that of IEC 61966-2-1, by columns.
const std::array<glm::dvec3, kSamples>& rec709PerSample() {
  static const std::array<glm::dvec3, kSamples> table = [] {
    const glm::dmat3 rec709FromXyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                                   0.0415560, 1.0572252);
    std::array<glm::dvec3, kSamples> made{};
    for (int i = 0; i < kSamples; ++i)
      made[static_cast<std::size_t>(i)] = rec709FromXyz * matchingAt(kFirst + kStep * i) * (kStep * 1e-9);
    return made;
  }();
  return table;
}

}  // namespace

glm::dvec3 blackbodyRadiance(double kelvin) {
  constexpr double kPlanck = 6.62607015e-34, kLight = 299792458.0, kBoltzmann = 1.380649e-23;
  if (!(kelvin > 0.0)) return glm::dvec3(0.0);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    const double metres = (kFirst + kStep * i) * 1e-9;
    const double exponent = kPlanck * kLight / (metres * kBoltzmann * kelvin);
    if (exponent > 700.0) continue;  // less than any double
    const double radiance = 2.0 * kPlanck * kLight * kLight / (std::pow(metres, 5.0) * std::expm1(exponent));
    sum += radiance * rec709PerSample()[static_cast<std::size_t>(i)];
  }
  return sum;
}

}  // namespace pellucid
