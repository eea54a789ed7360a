#include "composite/pass_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "composite/antialias.h"

namespace pellucid {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Up to this many passes the places in the pixel are searched sets without an order, and so is what is dealt to them.
constexpr int kFew = 16;
constexpr int kCandidates = 256;
constexpr int kMostSwapped = 256;  // more passes than these are as good as uncorrelated already
constexpr int kMostSwaps = 32;

using Order = std::vector<int>;

std::uint32_t mixed(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

Order shuffled(int count, std::uint32_t seed) {
  Order order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (int i = count; i > 1; --i) {
    const std::uint32_t hash = mixed(seed * 0x9e3779b9u + static_cast<std::uint32_t>(i));
    std::swap(order[static_cast<std::size_t>(i - 1)], order[hash % static_cast<std::uint32_t>(i)]);
  }
  return order;
}

double radicalInverse2(unsigned index) {
  double value = 0.0, digit = 0.5;
  for (; index; index >>= 1u, digit *= 0.5)
    if (index & 1u) value += digit;
  return value;
}

// Sobol's sequence in the dimensions that follow Hammersley's i / N and radical inverse, each by its primitive
// polynomial and first numbers (Joe, Kuo 2008).
struct Dimension {
  int degree;
  std::uint32_t inner;  // the polynomial's inner coefficients
  std::uint32_t first[3];
};
constexpr Dimension kTime{1, 0, {1, 0, 0}}, kLensX{2, 1, {1, 3, 0}}, kLensY{3, 1, {1, 3, 1}};

std::uint32_t sobol(unsigned index, const Dimension& dimension) {
  std::uint32_t numbers[32], result = 0;
  for (int k = 0; index >> k; ++k) {
    if (k < dimension.degree) {
      numbers[k] = dimension.first[k];
    } else {
      const std::uint32_t last = numbers[k - dimension.degree];
      numbers[k] = last ^ last << dimension.degree;
      for (int j = 1; j < dimension.degree; ++j)
        if (dimension.inner >> (dimension.degree - 1 - j) & 1u) numbers[k] ^= numbers[k - j] << j;
    }
    if (index >> k & 1u) result ^= numbers[k] << (31 - k);
  }
  return result;
}

// Its numbers by pass, brought to the middles of `count` equal parts.
std::vector<double> sobolParts(int count, const Dimension& dimension) {
  Order byValue(static_cast<std::size_t>(count));
  std::iota(byValue.begin(), byValue.end(), 0);
  std::sort(byValue.begin(), byValue.end(), [&](int a, int b) {
    return sobol(static_cast<unsigned>(a), dimension) < sobol(static_cast<unsigned>(b), dimension);
  });
  std::vector<double> parts(byValue.size());
  for (std::size_t k = 0; k < byValue.size(); ++k)
    parts[static_cast<std::size_t>(byValue[k])] = (static_cast<double>(k) + 0.5) / count;
  return parts;
}

// Distances within a pixel repeat at its borders: the next pixel has the same passes.
double around(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 1.0 - d);
}

// What is dealt to the passes: `count` tuples of numbers, and which of them pass i gets.
struct Dealt {
  std::vector<std::vector<double>> axes;  // each of `count` numbers
  Order order;

  double at(std::size_t axis, std::size_t pass) const { return axes[axis][static_cast<std::size_t>(order[pass])]; }
};

double leastDistance(const Dealt& dealt, const std::vector<glm::dvec2>& samples) {
  double least = 1e9;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double x = around(samples[i].x, samples[j].x), y = around(samples[i].y, samples[j].y);
      double sum = x * x + y * y;
      for (std::size_t a = 0; a < dealt.axes.size(); ++a) {
        const double d = dealt.at(a, i) - dealt.at(a, j);
        sum += d * d;
      }
      least = std::min(least, sum);
    }
  return least;
}

// Close in the pixel means far apart in what is dealt.
void spread(Dealt& dealt, const std::vector<glm::dvec2>& samples, std::uint32_t salt) {
  double largest = -1.0;
  Order best;
  for (std::uint32_t c = 0; c < kCandidates; ++c) {
    dealt.order = shuffled(static_cast<int>(samples.size()), salt + c);
    const double least = leastDistance(dealt, samples);
    if (least <= largest) continue;
    largest = least;
    best = dealt.order;
  }
  dealt.order = best;
}

// Swaps passes as long as that takes away from the covariance of places and what is dealt: blur neither leans nor is
// it wider or narrower than it should be.
void decorrelate(Dealt& dealt, const std::vector<glm::dvec2>& samples) {
  const std::size_t count = samples.size(), axes = dealt.axes.size();
  std::vector<glm::dvec2> covariance(axes, glm::dvec2(0.0));
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t i = 0; i < count; ++i) covariance[a] += (dealt.at(a, i) - 0.5) * (samples[i] - 0.5);
  for (int swaps = 0; swaps < kMostSwaps; ++swaps) {
    double least = 0.0;
    for (const glm::dvec2& c : covariance) least += glm::dot(c, c);
    std::size_t first = 0, second = 0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double sum = 0.0;
        for (std::size_t a = 0; a < axes; ++a) {
          const glm::dvec2 c = covariance[a] + (dealt.at(a, j) - dealt.at(a, i)) * (samples[i] - samples[j]);
          sum += glm::dot(c, c);
        }
        if (sum >= least) continue;
        least = sum;
        first = i;
        second = j;
      }
    if (first == second) return;
    for (std::size_t a = 0; a < axes; ++a)
      covariance[a] += (dealt.at(a, second) - dealt.at(a, first)) * (samples[first] - samples[second]);
    std::swap(dealt.order[first], dealt.order[second]);
  }
}

// Of as many numbers as there are passes, in the order of the passes where these are many.
Dealt deal(std::vector<std::vector<double>> axes, const std::vector<glm::dvec2>& samples, std::uint32_t salt) {
  const auto count = static_cast<int>(samples.size());
  Dealt dealt{std::move(axes), Order(samples.size())};
  std::iota(dealt.order.begin(), dealt.order.end(), 0);
  if (count <= kFew) spread(dealt, samples, salt);
  if (count <= kMostSwapped) decorrelate(dealt, samples);
  return dealt;
}

}  // namespace

std::vector<PassPoint> passPoints(int count) {
  std::vector<PassPoint> points(static_cast<std::size_t>(std::max(count, 1)));
  if (count <= 1) return points;
  std::vector<glm::dvec2> samples;
  std::vector<double> time, across, up;
  int padded = 1;
  while (padded < count) padded *= 2;
  for (int i = 0; i < count; ++i) {
    samples.push_back(samplePosition(i, count));
    time.push_back((i + 0.5) / count);
    up.push_back(radicalInverse2(static_cast<unsigned>(i)) + 0.5 / padded);
  }
  across = time;
  if (count > kFew) {
    time = sobolParts(count, kTime);
    across = sobolParts(count, kLensX);
    up = sobolParts(count, kLensY);
  }
  const Dealt times = deal({time}, samples, 1u), places = deal({across, up}, samples, 100003u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].time = times.at(0, i);
    points[i].lens = {places.at(0, i), places.at(1, i)};
  }
  return points;
}

glm::dvec2 lensPoint(glm::dvec2 unitSquare, int blades) {
  if (blades >= 3) {
    // Sectors by the first number, whose rest is spread over the triangle.
    const double scaled = unitSquare.x * blades;
    const int sector = std::min(static_cast<int>(scaled), blades - 1);
    const double root = std::sqrt(unitSquare.y), along = scaled - sector;
    const auto corner = [&](int k) {
      return glm::dvec2(std::cos(2.0 * kPi * k / blades), std::sin(2.0 * kPi * k / blades));
    };
    return root * ((1.0 - along) * corner(sector) + along * corner(sector + 1));
  }
  // Shirley and Chiu: squares about the centre become circles.
  const glm::dvec2 at = 2.0 * unitSquare - 1.0;
  if (at.x == 0.0 && at.y == 0.0) return {0.0, 0.0};
  const bool wide = std::abs(at.x) > std::abs(at.y);
  const double radius = wide ? at.x : at.y;
  const double angle = wide ? kPi / 4.0 * at.y / at.x : kPi / 2.0 - kPi / 4.0 * at.x / at.y;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace pellucid
