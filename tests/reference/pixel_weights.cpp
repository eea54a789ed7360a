#include "tests/reference/pixel_weights.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace pellucid::reference {
namespace {

// t from -1 to 1 over the filter's width.
double density(const std::string& shape, double t) {
  if (std::abs(t) >= 1.0) return 0.0;
  if (shape == "triangle") return 1.0 - std::abs(t);
  if (shape == "gaussian") return std::exp(-4.5 * t * t);
  if (shape == "blackman-harris") {
    const double angle = std::numbers::pi * (t + 1.0);
    return 0.35875 - 0.48829 * std::cos(angle) + 0.14128 * std::cos(2.0 * angle) - 0.01168 * std::cos(3.0 * angle);
  }
  return 1.0;
}

// Numbers in [0,1) from a place: those of splitmix64.
double scattered(std::uint64_t seed) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + 0x1234567ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

double PixelWeights::at(double x, double y) const {
  return density(shape, x / radius) * density(shape, y / radius);
}

Samples::Samples(const Picture& picture, const PixelWeights& weights, int perEdge)
    : weights_(weights), width_(picture.scene().eye.width), margin_(static_cast<int>(std::ceil(weights.radius - 0.5))) {
  std::uint64_t seed = 0;
  for (int y = -margin_; y < picture.scene().eye.height + margin_; ++y)
    for (int x = -margin_; x < width_ + margin_; ++x) {
      std::vector<Sampled> cell;
      for (int j = 0; j < perEdge; ++j)
        for (int i = 0; i < perEdge; ++i, seed += 2) {
          Sampled sample;
          sample.x = x + (i + scattered(seed)) / perEdge;
          sample.y = y + (j + scattered(seed + 1)) / perEdge;
          const Column column = picture.columnAt(sample.x, sample.y);
          sample.opaque = column.opaque;
          sample.background = picture.background(column);
          sample.value = picture.at(column);
          cell.push_back(sample);
        }
      cells_.push_back(std::move(cell));
    }
}

Vec4 Samples::mean(int x, int y, Vec4 Sampled::*member) const {
  Vec4 sum(0.0);
  double weights = 0.0;
  under(x, y, [&](const Sampled& sample, double weight) {
    sum += weight * sample.*member;
    weights += weight;
  });
  return sum / weights;
}

}  // namespace pellucid::reference
