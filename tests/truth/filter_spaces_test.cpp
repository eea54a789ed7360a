// The rule for what filters let through in another space, against spectra: ten filters before forty-one backgrounds.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "gbuffer/colour_space.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr int kSamples = 81;  // 380 to 780 nm
using Spectrum = std::array<double, kSamples>;

double nanometres(int i) {
  return 380.0 + 5.0 * i;
}
// A bell with a width on each side.
double bell(double x, double middle, double below, double above) {
  const double t = (x - middle) / (x < middle ? below : above);
  return std::exp(-0.5 * t * t);
}
double step(double x, double middle, double width) {
  return 1.0 / (1.0 + std::exp(-(x - middle) / width));
}
Spectrum spectrum(const std::function<double(double)>& value) {
  Spectrum result;
  for (int i = 0; i < kSamples; ++i) result[static_cast<std::size_t>(i)] = value(nanometres(i));
  return result;
}
Spectrum product(const Spectrum& a, const Spectrum& b) {
  Spectrum result;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

// CIE 1931 after Wyman, Sloan and Shirley, JCGT 2013, under Planck's light of 6504 K.
glm::dvec3 xyzOf(const Spectrum& light) {
  glm::dvec3 sum(0.0);
  double white = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double l = nanometres(i), metres = l * 1e-9;
    const double lamp = 1e-30 / (std::pow(metres, 5) * std::expm1(0.0143877688 / (metres * 6504.0)));
    const glm::dvec3 eye{
        1.056 * bell(l, 599.8, 37.9, 31.0) + 0.362 * bell(l, 442.0, 16.0, 26.7) - 0.065 * bell(l, 501.1, 20.4, 26.2),
        0.821 * bell(l, 568.8, 46.9, 40.5) + 0.286 * bell(l, 530.9, 16.3, 31.1),
        1.217 * bell(l, 437.0, 11.8, 36.0) + 0.681 * bell(l, 459.0, 26.0, 13.8)};
    sum += eye * (lamp * light[static_cast<std::size_t>(i)]);
    white += eye.y * lamp;
  }
  return sum / white;
}

// Linear Rec.709, that light being white.
glm::dvec3 rec709Of(const Spectrum& light) {
  static const glm::dmat3 matrix = [] {
    const glm::dvec3 white = xyzOf(spectrum([](double) { return 1.0; }));
    const double sum = white.x + white.y + white.z;
    // XYZ as a space of its own, with that white.
    const Chromaticities xyz{{1, 0}, {0, 1}, {0, 0}, {white.x / sum, white.y / sum}};
    const glm::dmat3 scaled = glm::inverse(*fromRec709(xyz));
    return glm::dmat3(scaled[0] / white.x, scaled[1] / white.y, scaled[2] / white.z);
  }();
  return matrix * xyzOf(light);
}

std::vector<Spectrum> filters() {
  const auto of = [](auto value) { return spectrum(value); };
  return {of([](double l) { return .05 + .9 * step(l, 600, 12); }),
          of([](double l) { return .04 + .9 * step(l, 560, 15); }),
          of([](double l) { return .03 + .92 * step(l, 510, 15); }),
          of([](double l) { return .03 + .85 * bell(l, 530, 35, 35); }),
          of([](double l) { return .05 + .85 * (1 - step(l, 570, 15)); }),
          of([](double l) { return .03 + .85 * bell(l, 455, 35, 35); }),
          of([](double l) { return .05 + .85 * (1 - step(l, 490, 12) * (1 - step(l, 600, 12))); }),
          of([](double l) { return .1 + .6 * bell(l, 545, 70, 60); }),
          of([](double l) { return .02 + .8 * step(l, 545, 30); }),
          of([](double l) { return .7 + .25 * step(l, 590, 25); })};
}

std::vector<Spectrum> backgrounds() {
  std::vector<Spectrum> all{spectrum([](double) { return 1.0; })};
  test::Random random(5);
  for (int k = 0; k < 40; ++k) {
    double height[4], middle[4], width[4];
    for (int j = 0; j < 4; ++j) {
      height[j] = 2.0 * random.uniform() - 1.0;
      middle[j] = 400.0 + 300.0 * random.uniform();
      width[j] = 30.0 + 60.0 * random.uniform();
    }
    Spectrum sum = spectrum([&](double l) {
      double value = 0.0;
      for (int j = 0; j < 4; ++j) value += height[j] * bell(l, middle[j], width[j], width[j]);
      return value;
    });
    const double least = *std::min_element(sum.begin(), sum.end()), most = *std::max_element(sum.begin(), sum.end());
    const double brightness = .9 * (.3 + .7 * random.uniform());
    for (double& value : sum) value = .03 + brightness * (value - least) / (most - least);
    all.push_back(sum);
  }
  return all;
}

glm::dvec3 unit(const glm::dvec3& value) {
  return glm::clamp(value, glm::dvec3(0.0), glm::dvec3(1.0));
}

// What three rules make of a filter that glTF tells in linear Rec.709.
struct Rule {
  const char* name;
  glm::dvec3 (*filter)(const glm::dmat3& matrix, const glm::dvec3& told);
};
const Rule kRules[] = {
    {"white light through it", [](const glm::dmat3& m, const glm::dvec3& t) { return unit(m * t); }},
    {"numbers as they are", [](const glm::dmat3&, const glm::dvec3& t) { return t; }},
    {"diagonal of the filter's matrix",
     [](const glm::dmat3& m, const glm::dvec3& t) {
       const glm::dmat3 back = glm::inverse(m);
       glm::dvec3 diagonal(0.0);
       for (int r = 0; r < 3; ++r)
         for (int c = 0; c < 3; ++c) diagonal[r] += m[c][r] * t[c] * back[r][c];
       return unit(diagonal);
     }},
};

TEST(FilterSpaces, WhiteLightThroughAFilterIsNearestToSpectra) {
  const std::vector<Spectrum> glasses = filters(), behind = backgrounds();
  for (const NamedSpace& row : namedSpaces()) {
    const glm::dmat3 matrix = spaceOf(row.chromaticities)->fromRec709;
    double error[3] = {}, white[3] = {};
    for (const Spectrum& glass : glasses) {
      const glm::dvec3 told = unit(rec709Of(glass));
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 filter = kRules[k].filter(matrix, told);
        for (std::size_t b = 0; b < behind.size(); ++b) {
          const glm::dvec3 off = filter * (matrix * rec709Of(behind[b])) - matrix * rec709Of(product(glass, behind[b]));
          const double square = glm::dot(off, off) / 3.0;
          error[k] += square / static_cast<double>(glasses.size() * behind.size());
          if (b == 0) white[k] += square / static_cast<double>(glasses.size());
        }
      }
    }
    for (int k = 0; k < 3; ++k)
      std::printf("%-22s %-32s rmse %.4f, before white %.4f\n", row.name, kRules[k].name, std::sqrt(error[k]),
                  std::sqrt(white[k]));
    for (int k = 1; k < 3; ++k) EXPECT_LE(error[0], error[k] * (1.0 + 1e-9)) << row.name << ", " << kRules[k].name;
    EXPECT_LT(std::sqrt(error[0]), 0.045) << row.name << ": no worse than in Rec.709, in which glTF tells it";
  }
}

}  // namespace
}  // namespace pellucid
