#include "samples/foliage/plants.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/hash.h"

namespace pellucid::samples {
namespace {

constexpr int kSlats = 5;  // per panel

template <class Inside, class Colour>
Image<glm::vec4> mask(int edge, Inside inside, Colour colour) {
  Image<glm::vec4> image(edge, edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const double u = (x + 0.5) / edge, v = 1.0 - (y + 0.5) / edge;
      image.at(x, y) = glm::vec4(glm::vec3(colour(u, v)), inside(u, v) ? 1.0f : 0.0f);
    }
  return image;
}

// Half the width of a leaf at height v: a pointed oval on a stalk.
double leafEdge(double v) {
  if (v < 0.04 || v > 0.98) return 0.0;
  if (v < 0.14) return 0.02;
  const double along = (v - 0.14) / 0.84;
  return 0.42 * std::pow(std::sin(glm::pi<double>() * std::pow(along, 0.75)), 0.8) * (1.0 - 0.25 * along);
}

}  // namespace

Image<glm::vec4> leafMask(int edge) {
  return mask(
      edge, [](double u, double v) { return std::abs(u - 0.5) < leafEdge(v); },
      [](double u, double v) {
        const double across = std::abs(u - 0.5);
        const double vein = std::exp(-std::pow(across / 0.012, 2.0)) +
                            0.6 * std::exp(-std::pow(std::remainder(across * 1.6 - v, 0.13) / 0.012, 2.0));
        return glm::mix(glm::dvec3(0.29, 0.5, 0.16), glm::dvec3(0.52, 0.66, 0.3), std::min(0.7 * vein, 1.0));
      });
}

Image<glm::vec4> slatMask(int edge) {
  return mask(
      edge,
      [](double u, double v) {
        const double across = std::abs(u * kSlats - std::floor(u * kSlats) - 0.5);
        const bool rail = std::abs(v - 0.2) < 0.04 || std::abs(v - 0.72) < 0.04;
        return rail || (across < 0.31 && v < 0.98 - 0.25 * across);
      },
      [](double u, double v) {
        const double grain = 0.5 + 0.5 * std::sin(90.0 * u + 2.0 * std::sin(9.0 * v));
        return glm::mix(glm::dvec3(0.72, 0.66, 0.56), glm::dvec3(0.8, 0.75, 0.66), grain);
      });
}

std::vector<Card> crown(glm::dvec3 centre, double radius, int leaves, double leafLength, std::uint32_t seed) {
  std::vector<Card> cards;
  for (int i = 0; i < leaves; ++i) {
    const auto random = [&](std::uint32_t k) { return unit(hash(seed, static_cast<std::uint32_t>(i), k)); };
    // Uniform directions; denser towards the shell, as light makes leaves grow.
    const double height = 2.0 * random(0) - 1.0, turn = 2.0 * glm::pi<double>() * random(1);
    const double ring = std::sqrt(1.0 - height * height), away = radius * std::pow(random(2), 0.25);
    const glm::dvec3 outwards(ring * std::cos(turn), height, ring * std::sin(turn));
    // Leaves face outwards and up, each its own way, and hang.
    const glm::dvec3 wobble(random(3) - 0.5, random(4) - 0.5, random(5) - 0.5);
    const glm::dvec3 facing = glm::normalize(outwards + glm::dvec3(0.0, 0.6, 0.0) + 1.6 * wobble);
    const glm::dvec3 hang = glm::normalize(glm::dvec3(random(6) - 0.5, -0.8, random(7) - 0.5));
    const glm::dvec3 right = glm::normalize(glm::cross(-hang, facing)), up = glm::cross(facing, right);
    const double length = leafLength * (0.75 + 0.5 * random(8)), width = 0.75 * length;
    cards.push_back({centre + away * outwards - 0.5 * width * right, width * right, length * up});
  }
  return cards;
}

std::vector<Card> fence(glm::dvec3 corner, double width, double height, int panels, double gap) {
  std::vector<Card> cards;
  const double panel = width / panels;
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < panels; ++i)
      cards.push_back({corner + glm::dvec3(panel * i + (row == 1 ? 0.5 * panel / kSlats : 0.0), 0.0, -gap * row),
                       glm::dvec3(panel, 0.0, 0.0), glm::dvec3(0.0, height, 0.0)});
  return cards;
}

Mesh meshOf(const std::vector<Card>& cards) {
  Mesh mesh;
  for (const Card& card : cards) addQuad(mesh, card.corner, card.right, card.up);
  return mesh;
}

}  // namespace pellucid::samples
