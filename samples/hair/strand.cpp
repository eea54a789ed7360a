#include "samples/hair/strand.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/hash.h"

namespace pellucid::samples {
namespace {

constexpr std::uint32_t kLocks = 420;
constexpr double kTurn = 2.0 * glm::pi<double>();

double random(std::uint32_t number, std::uint32_t what, double low, double high) {
  return low + (high - low) * unit(hash(number, what, 41));
}

// Uniform over where hair grows.
glm::dvec3 rootDirection(std::uint32_t seed) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    const double y = random(hash(seed, attempt), 1, -0.45, 1.0), turn = random(hash(seed, attempt), 2, 0.0, kTurn);
    const double across = std::sqrt(1.0 - y * y);
    const glm::dvec3 d(across * std::sin(turn), y, across * std::cos(turn));
    if (growsHair(d)) return d;
  }
}

}  // namespace

bool growsHair(glm::dvec3 d) {
  return d.y > 0.35 + 0.75 * d.z - 0.35 * std::abs(d.x) || (d.z > 0.0 && d.y > 0.62 + 0.2 * d.z);
}

Strand growStrand(std::uint32_t number, int segments) {
  // The hairs of a lock start side by side and come together towards the tip.
  const std::uint32_t lock = hash(number, 7) % kLocks, seed = hash(lock, 11);
  const glm::dvec3 middle = rootDirection(seed);
  const glm::dvec3 scatter(random(number, 3, -1, 1), random(number, 4, -1, 1), random(number, 5, -1, 1));
  const glm::dvec3 out = glm::normalize(middle + 0.17 * scatter);
  Strand strand;
  strand.depth = random(number, 6, 0.0, 1.0);
  strand.shade = random(seed, 7, -1.0, 1.0) * 0.7 + random(number, 8, -0.3, 0.3);

  const double length = random(seed, 9, 0.27, 0.35) * random(number, 10, 0.9, 1.06), step = length / segments;
  const double lift = 0.003 + 0.016 * (1.0 - strand.depth);  // how far from the skin it lies
  const double side = out.x >= 0.0 ? 1.0 : -1.0;             // of the parting
  const double phase = random(seed, 12, 0.0, kTurn), waves = random(seed, 13, 2.2, 3.4);
  const glm::dvec3 spread = 0.011 * scatter;

  glm::dvec3 at = kSkull.centre + kSkull.radius * out;
  // Combed away from the parting, down and a little back.
  const glm::dvec3 comb(0.9 * side, -0.45, -0.25);
  glm::dvec3 heading = glm::normalize(0.3 * out + comb - glm::dot(comb, out) * out);
  for (int i = 0; i <= segments; ++i) {
    const double t = static_cast<double>(i) / segments;
    // What the lock's wave and the hair's own place in it add; nothing at the root.
    const double swing = kTurn * waves * t + phase, reach = 0.0085 * t * (1.2 - 0.4 * t);
    const glm::dvec3 wave = reach * glm::dvec3(std::cos(swing), 0.25 * std::sin(2.0 * swing), std::sin(swing));
    const double gather = t < 0.25 ? t * 4.0 : 1.0 - 0.75 * (t - 0.25) / 0.75;
    glm::dvec3 shown = at + wave + gather * spread;
    for (const Ball& ball : kBody) {
      const glm::dvec3 from = shown - ball.centre;
      const double least = ball.radius + lift * std::min(1.0, 6.0 * t) + 2e-4;
      if (glm::dot(from, from) < least * least) shown = ball.centre + least * glm::normalize(from);
    }
    strand.points.push_back(shown);

    heading = glm::normalize(glm::mix(heading, glm::dvec3(0.03 * side, -1.0, -0.05), 1.0 - std::exp(-28.0 * step)));
    at += step * heading;
    for (const Ball& ball : kBody) {
      const glm::dvec3 from = at - ball.centre;
      const double least = ball.radius + lift;
      if (t < 0.02 || glm::dot(from, from) >= least * least) continue;
      const glm::dvec3 normal = glm::normalize(from);
      at = ball.centre + least * normal;
      heading = glm::normalize(heading - std::min(0.0, glm::dot(heading, normal)) * normal);
    }
  }
  return strand;
}

}  // namespace pellucid::samples
