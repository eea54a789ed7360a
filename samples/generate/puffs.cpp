#include "samples/generate/puffs.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/generate/files.h"
#include "samples/generate/hash.h"

namespace pellucid::samples {
namespace {

constexpr int kPuffEdge = 96;
constexpr std::size_t kPuffs = 2;

// Smooth noise on the integer lattice. [0,1]
double noise(glm::dvec2 p, std::uint32_t seed) {
  const glm::dvec2 cell = glm::floor(p), f = p - cell, s = f * f * (3.0 - 2.0 * f);
  const auto corner = [&](int dx, int dy) {
    return unit(hash(static_cast<std::uint32_t>(static_cast<int>(cell.x) + dx),
                     static_cast<std::uint32_t>(static_cast<int>(cell.y) + dy), seed));
  };
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
}

}  // namespace

Image<glm::vec4> puff(std::uint32_t seed) {
  Image<glm::vec4> texels(kPuffEdge, kPuffEdge);
  for (int y = 0; y < kPuffEdge; ++y)
    for (int x = 0; x < kPuffEdge; ++x) {
      const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * (2.0 / kPuffEdge) - 1.0;
      double ragged = 0.0;
      for (std::uint32_t octave = 0; octave < 4; ++octave)
        ragged += noise((p + 1.0) * (2.5 * (1 << octave)), hash(seed, octave)) / (2 << octave);
      const double ball = std::max(0.0, 1.0 - glm::length(p));
      const double density = std::clamp(3.0 * ball * ragged - 0.15 * (1.0 - ball), 0.0, 1.0);
      texels.at(x, y) = glm::vec4(1.0f, 1.0f, 1.0f, static_cast<float>(density * density * (3.0 - 2.0 * density)));
    }
  return texels;
}

void addCloud(Glb& glb, const Cloud& cloud, const std::vector<PuffCard>& cards) {
  Mesh meshes[kPuffs];
  for (std::size_t i = 0; i < cards.size(); ++i) {
    const PuffCard& card = cards[i];
    const double spin = 2.0 * glm::pi<double>() * unit(hash(static_cast<std::uint32_t>(i), 1, cloud.seed));
    const glm::dvec3 right = card.edge * glm::dvec3(std::cos(spin), std::sin(spin), 0.0);
    const glm::dvec3 up(-right.y, right.x, 0.0);
    Mesh& mesh = meshes[i % kPuffs];
    addQuad(mesh, card.middle - 0.5 * (right + up), right, up);
    mesh.colours.insert(mesh.colours.end(), 4, glm::vec4(card.colour, 1.0));
  }
  for (std::size_t i = 0; i < kPuffs; ++i) {
    if (meshes[i].positions.empty()) continue;
    const std::string name = cloud.name + " " + std::to_string(i);
    const int texture = glb.addTexture(name, encodePng(puff(cloud.seed + static_cast<std::uint32_t>(i))));
    const int material = glb.addMaterial({{"name", cloud.name},
                                          {"alphaMode", "BLEND"},
                                          {"doubleSided", true},
                                          {"pbrMetallicRoughness",
                                           {{"baseColorFactor", {1.0, 1.0, 1.0, cloud.opacity}},
                                            {"baseColorTexture", {{"index", texture}}},
                                            {"metallicFactor", 0.0}}},
                                          {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}},
                                          {"extras", {{"pellucid", cloud.extras}}}});
    glb.addMesh(name, meshes[i], material);
  }
}

}  // namespace pellucid::samples
