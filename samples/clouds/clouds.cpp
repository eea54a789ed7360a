// Cumulus over a plain: hundreds of soft cards with their light baked, before a sky. PT17 fig. 18.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/files.h"
#include "samples/generate/hash.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

constexpr int kEdge = 128, kPuffs = 3;

// Smooth noise on the integer lattice. [0,1]
double noise(glm::dvec2 p, std::uint32_t seed) {
  const glm::dvec2 cell = glm::floor(p), f = p - cell, s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const auto corner = [&](int dx, int dy) {
    return unit(hash(static_cast<std::uint32_t>(static_cast<int>(cell.x) + dx),
                     static_cast<std::uint32_t>(static_cast<int>(cell.y) + dy), seed));
  };
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
}

double turbulence(glm::dvec2 p, std::uint32_t seed) {
  double sum = 0.0;
  for (std::uint32_t octave = 0; octave < 5; ++octave)
    sum += noise(p * static_cast<double>(1 << octave), hash(seed, octave)) / (2 << octave);
  return sum;
}

// White; opacity of a cauliflower of vapour, clear at the rim.
Image<glm::vec4> puff(std::uint32_t seed) {
  Image<glm::vec4> texels(kEdge, kEdge);
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) {
      const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * (2.0 / kEdge) - 1.0;
      const double ragged = turbulence(3.0 * p + 9.0, seed);
      const double body = 1.0 - glm::length(p) - 0.75 * (0.62 - ragged);
      const double density = std::clamp(2.2 * body, 0.0, 1.0) * std::clamp(4.0 * (1.0 - glm::length(p)), 0.0, 1.0);
      texels.at(x, y) = glm::vec4(1.0f, 1.0f, 1.0f, static_cast<float>(density * density * (3.0 - 2.0 * density)));
    }
  return texels;
}

struct Cloud {
  glm::dvec3 base;  // middle of its flat underside, metres
  double width, height;
  int cards;
};
const Cloud kClouds[] = {{{-330.0, 205.0, -1150.0}, 520.0, 215.0, 90}, {{300.0, 185.0, -980.0}, 390.0, 190.0, 80},
                         {{30.0, 330.0, -1750.0}, 700.0, 230.0, 80},   {{-820.0, 360.0, -2300.0}, 800.0, 260.0, 60},
                         {{900.0, 340.0, -2400.0}, 860.0, 250.0, 60},  {{-60.0, 262.0, -740.0}, 170.0, 62.0, 44},
                         {{-265.0, 275.0, -800.0}, 110.0, 44.0, 30}};

struct Puff {
  glm::dvec3 centre;
  double edge;  // metres
  std::uint32_t seed;
};

// Domes on a flat base: lobes of their own height, each filled with puffs that are larger inside.
std::vector<Puff> puffsOf(const Cloud& cloud, std::uint32_t number) {
  constexpr std::uint32_t kLobes = 5;
  std::vector<Puff> puffs;
  for (int i = 0; i < cloud.cards; ++i) {
    const std::uint32_t seed = hash(number, static_cast<std::uint32_t>(i), 5);
    const auto random = [&](std::uint32_t what) { return unit(hash(seed, what)); };
    const std::uint32_t lobe = hash(seed, 99) % kLobes;
    const double place = (lobe + 0.5) / kLobes - 0.5;
    const double rise = (1.0 - 2.6 * place * place) * (0.55 + 0.6 * unit(hash(number, lobe, 8)));
    const double angle = 2.0 * glm::pi<double>() * random(1), across = std::sqrt(random(2)), up = random(3);
    const double taper = std::sqrt(1.0 - 0.75 * up * up);
    const glm::dvec3 offset(cloud.width * (0.8 * place + 0.2 * across * taper * std::cos(angle)),
                            cloud.height * rise * (0.1 + 0.9 * up),
                            0.35 * cloud.width * across * taper * std::sin(angle));
    puffs.push_back({cloud.base + offset, cloud.height * (0.5 + 0.35 * random(4)) * (1.0 - 0.35 * up), seed});
  }
  return puffs;
}

// What of the sun is left after the puffs that lie between.
double sunAt(const Puff& puff, const std::vector<Puff>& others, glm::dvec3 toSun) {
  double depth = 0.0;
  for (const Puff& other : others) {
    const glm::dvec3 to = other.centre - puff.centre;
    const double along = glm::dot(to, toSun), aside = glm::length(to - along * toSun);
    if (along > 0.0) depth += std::exp(-8.0 * aside * aside / (other.edge * other.edge));
  }
  return std::exp(-0.42 * depth);
}

glm::dvec3 skyAt(glm::dvec3 fromEye, glm::dvec3 toSun) {
  const double up = std::clamp(fromEye.y, 0.0, 1.0), near = std::max(0.0, glm::dot(fromEye, toSun));
  const glm::dvec3 gradient = glm::mix(glm::dvec3(0.62, 0.74, 0.86), glm::dvec3(0.13, 0.28, 0.62), std::pow(up, 0.45));
  return gradient + glm::dvec3(1.0, 0.85, 0.6) * (0.25 * std::pow(near, 6.0) + 0.5 * std::pow(near, 120.0));
}

glm::dvec3 fields(glm::dvec3 p) {
  const glm::dvec2 turned(0.83 * p.x + 0.56 * p.z, 0.83 * p.z - 0.56 * p.x);
  const glm::dvec2 cell = glm::floor(turned / glm::dvec2(85.0, 130.0));
  const std::uint32_t seed = hash(static_cast<std::uint32_t>(static_cast<int>(cell.x)),
                                  static_cast<std::uint32_t>(static_cast<int>(cell.y)), 3);
  const glm::dvec3 kinds[] = {{0.16, 0.24, 0.07}, {0.3, 0.28, 0.1}, {0.1, 0.17, 0.05}, {0.22, 0.27, 0.1}};
  const double far = 1.0 - std::exp(p.z / 2600.0);
  return glm::mix(kinds[seed % 4] * (0.85 + 0.3 * unit(hash(seed, 2))), glm::dvec3(0.42, 0.5, 0.58), far);
}

}  // namespace

Sample clouds() {
  Sample sample;
  sample.view.eye = {0.0, 60.0, 0.0};
  sample.view.target = {0.0, 205.0, -1000.0};
  sample.view.yfov = 0.62;
  sample.view.nearest = 10.0;
  sample.view.farthest = 5000.0;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.8, 0.5, 0.25));
  studio.sunIrradiance = {3.3, 3.0, 2.5};
  studio.ambient = {0.35, 0.42, 0.52};
  studio.ambientReach = 40.0;
  const glm::dvec3 toSun = studio.toSun;
  studio.sky = [toSun](glm::dvec3 fromEye) { return skyAt(fromEye, toSun); };
  studio.shapes = {{ShapeKind::box, {0.0, -5.0, -4000.0}, {9000.0, 5.0, 4500.0}, 0.0, fields}};
  // A ridge far away that the clouds stand before and behind.
  for (std::uint32_t i = 0; i < 14; ++i) {
    const double radius = 900.0 + 700.0 * unit(hash(i, 61));
    const double height = 30.0 + 60.0 * unit(hash(i, 62));
    studio.shapes.push_back({ShapeKind::sphere,
                             {-2900.0 + 420.0 * i, height - radius, -2700.0 - 900.0 * unit(hash(i, 63))},
                             glm::dvec3(radius),
                             0.0,
                             plain(glm::dvec3(0.2, 0.28, 0.33) * (0.9 + 0.2 * unit(hash(i, 64))))});
  }

  int materials[kPuffs];
  for (int i = 0; i < kPuffs; ++i) {
    const std::string name = "vapour " + std::to_string(i);
    const int texture = sample.glb.addTexture(name, encodePng(puff(static_cast<std::uint32_t>(i) + 21)));
    materials[i] = sample.glb.addMaterial({{"name", name},
                                           {"alphaMode", "BLEND"},
                                           {"doubleSided", true},
                                           {"pbrMetallicRoughness",
                                            {{"baseColorFactor", {1.0, 1.0, 1.0, 0.6}},
                                             {"baseColorTexture", {{"index", texture}}},
                                             {"metallicFactor", 0.0}}},
                                           {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
  }
  Mesh cards[kPuffs];
  std::uint32_t number = 0;
  for (const Cloud& cloud : kClouds) {
    const std::vector<Puff> puffs = puffsOf(cloud, number++);
    for (const Puff& puff : puffs) {
      // Facing the eye, each turned in its plane.
      const double spin = 2.0 * glm::pi<double>() * unit(hash(puff.seed, 6));
      const glm::dvec3 toEye = glm::normalize(sample.view.eye - puff.centre);
      const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), toEye)), y = glm::cross(toEye, x);
      const glm::dvec3 right = puff.edge * (std::cos(spin) * x + std::sin(spin) * y);
      const glm::dvec3 up = puff.edge * (std::cos(spin) * y - std::sin(spin) * x);
      Mesh& mesh = cards[puff.seed % kPuffs];
      addQuad(mesh, puff.centre - 0.5 * (right + up), right, up);
      const double sun = sunAt(puff, puffs, toSun);
      const double high = std::clamp((puff.centre.y - cloud.base.y) / cloud.height, 0.0, 1.0);
      const glm::dvec3 shade = glm::mix(glm::dvec3(0.2, 0.25, 0.33), glm::dvec3(0.42, 0.49, 0.6), high);
      const glm::dvec3 lit = shade + sun * glm::dvec3(0.75, 0.68, 0.56);
      // Air between the eye and a far cloud.
      const double air = 1.0 - std::exp(-glm::distance(sample.view.eye, puff.centre) / 7000.0);
      const glm::vec4 colour(glm::clamp(glm::mix(lit, glm::dvec3(0.6, 0.72, 0.84), air), 0.0, 1.0), 1.0);
      mesh.colours.insert(mesh.colours.end(), 4, colour);
    }
  }
  for (int i = 0; i < kPuffs; ++i) sample.glb.addMesh("clouds " + std::to_string(i), cards[i], materials[i]);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
