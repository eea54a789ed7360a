// Power moments of the absorbance over logarithmic depth in the pixel's own range; three sets, one per channel.
// Münstermann, Krumpen, Klein, Peters: Moment-Based Order-Independent Transparency (2018)
#include <algorithm>
#include <array>
#include <cmath>

#include "composite/methods/method.h"

namespace pellucid {
namespace {

constexpr int kMost = 8;
// Where between "a layer does not shade itself" and "it does" a step counts. The paper's better value for thin layers.
constexpr double kOverestimation = 0.25;

// Bias towards a well-behaved set, for float moments of orders 4, 6, 8.
struct Bias {
  double strength;
  std::array<double, kMost> target;
};
constexpr Bias kBias[3] = {{5e-7, {0, .375, 0, .375, 0, 0, 0, 0}},
                           {5e-6, {0, .48, 0, .451, 0, .45, 0, 0}},
                           {5e-5, {0, .75, 0, .677, 0, .63, 0, .6}}};

using Vector = std::array<double, kMost / 2 + 1>;

// Solves the Hankel system of moments (b[0] = 1) by Cholesky. False when it is not positive definite.
bool solveHankel(const std::array<double, kMost + 1>& b, int n, Vector& x) {
  double lower[kMost / 2 + 1][kMost / 2 + 1] = {};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = b[static_cast<std::size_t>(i + j)];
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      if (i == j) {
        if (!(sum > 0.0)) return false;
        lower[i][i] = std::sqrt(sum);
      } else {
        lower[i][j] = sum / lower[j][j];
      }
    }
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k < i; ++k) x[static_cast<std::size_t>(i)] -= lower[i][k] * x[static_cast<std::size_t>(k)];
    x[static_cast<std::size_t>(i)] /= lower[i][i];
  }
  for (int i = n; i >= 0; --i) {
    for (int k = i + 1; k <= n; ++k) x[static_cast<std::size_t>(i)] -= lower[k][i] * x[static_cast<std::size_t>(k)];
    x[static_cast<std::size_t>(i)] /= lower[i][i];
  }
  return true;
}

double valueOf(const std::vector<double>& polynomial, double x) {
  double value = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) value = value * x + polynomial[i];
  return value;
}

// Real roots, all of them simple, between the roots of the derivative.
std::vector<double> realRoots(std::vector<double> polynomial) {
  double largest = 0;
  for (const double c : polynomial) largest = std::max(largest, std::abs(c));
  while (polynomial.size() > 1 && std::abs(polynomial.back()) <= 1e-13 * largest) polynomial.pop_back();
  const std::size_t degree = polynomial.size() - 1;
  if (degree == 0) return {};
  if (degree == 1) return {-polynomial[0] / polynomial[1]};
  std::vector<double> derivative;
  for (std::size_t i = 1; i <= degree; ++i) derivative.push_back(static_cast<double>(i) * polynomial[i]);
  std::vector<double> edges = realRoots(derivative);
  double bound = 0;  // Cauchy's
  for (std::size_t i = 0; i < degree; ++i) bound = std::max(bound, std::abs(polynomial[i] / polynomial[degree]));
  edges.insert(edges.begin(), -1.0 - bound);
  edges.push_back(1.0 + bound);
  std::vector<double> roots;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    double low = edges[i], high = edges[i + 1];
    const bool rising = valueOf(polynomial, low) < 0.0;
    if ((valueOf(polynomial, high) < 0.0) == rising) continue;
    for (int step = 0; step < 80; ++step) {
      const double middle = 0.5 * (low + high);
      ((valueOf(polynomial, middle) < 0.0) == rising ? low : high) = middle;
    }
    roots.push_back(0.5 * (low + high));
  }
  return roots;
}

// Part of the absorbance that lies in front of zeta: the dot product of the moments with the polynomial that runs
// through 1 at nodes before it, 0 behind it, and the overestimation at it (Newton's divided differences).
double partInFront(const std::array<double, kMost + 1>& b, int order, double zeta) {
  const int n = order / 2;
  Vector kernel{};
  double power = 1;
  for (int i = 0; i <= n; ++i, power *= zeta) kernel[static_cast<std::size_t>(i)] = power;
  if (!solveHankel(b, n, kernel)) return 0.5;
  std::vector<double> nodes = realRoots({kernel.begin(), kernel.begin() + n + 1});
  std::vector<double> values;
  for (const double node : nodes) values.push_back(node < zeta ? 1.0 : 0.0);
  nodes.insert(nodes.begin(), zeta);
  values.insert(values.begin(), kOverestimation);
  const std::size_t count = nodes.size();
  for (std::size_t level = 1; level < count; ++level)
    for (std::size_t i = count - 1; i >= level; --i)
      values[i] = (values[i] - values[i - 1]) / (nodes[i] - nodes[i - level]);
  // Newton form to powers, dotted with the moments on the way.
  std::vector<double> product{1.0};
  double part = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double dot = 0;
    for (std::size_t k = 0; k < product.size(); ++k) dot += product[k] * b[k];
    part += values[i] * dot;
    std::vector<double> next(product.size() + 1, 0.0);
    for (std::size_t k = 0; k < product.size(); ++k) {
      next[k + 1] += product[k];
      next[k] -= nodes[i] * product[k];
    }
    product = std::move(next);
  }
  return std::isfinite(part) ? std::clamp(part, 0.0, 1.0) : 0.5;
}

}  // namespace

LayerMix mixMoments(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  double low = layers[0].z, high = low;
  for (const MethodLayer& layer : layers) {
    low = std::min(low, layer.z);
    high = std::max(high, layer.z);
  }
  const double logLow = std::log(low), logSpan = std::log(high) - logLow;
  const auto place = [&](double z) { return logSpan > 0.0 ? 2.0 * (std::log(z) - logLow) / logSpan - 1.0 : 0.0; };
  const Bias& bias = kBias[choice.order / 2 - 2];
  std::vector<glm::dvec3> before(layers.size());
  for (int c = 0; c < 3; ++c) {
    std::array<double, kMost + 1> b{};
    for (const MethodLayer& layer : layers) {
      double power = absorbanceOf(layer.opacity)[c];
      const double zeta = place(layer.z);
      for (int k = 0; k <= choice.order; ++k, power *= zeta) b[static_cast<std::size_t>(k)] += power;
    }
    const double total = b[0];
    b[0] = 1.0;
    for (int k = 1; k <= choice.order; ++k) {
      double& moment = b[static_cast<std::size_t>(k)];
      moment = total > 0.0 ? moment / total : 0.0;
      moment += bias.strength * (bias.target[static_cast<std::size_t>(k - 1)] - moment);
    }
    for (std::size_t i = 0; i < layers.size(); ++i)
      before[i][c] = total > 0.0 ? std::exp(-total * partInFront(b, choice.order, place(layers[i].z))) : 1.0;
  }
  return mixByTransmittance(layers, before);
}

}  // namespace pellucid
