#include "tests/campaign/stacks.h"

#include <cmath>

#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kColumns = 20, kRows = 10, kCellWidth = 8, kCellHeight = 9;
constexpr std::uint32_t kDeepest = 60;

Material glass(float roughness, bool volume) {
  Material material;
  material.transmission = 0.8f;
  material.metallic = 0.0f;
  material.roughness = roughness;
  material.doubleSided = true;
  material.volume = volume;
  material.thickness = volume ? 0.1f : 0.0f;
  material.baseColor = glm::vec4(0.9f, 0.5f, 0.7f, 1.0f);
  return material;
}

// Quads of one material; each has a colour and a coverage of its own, in its vertices.
struct Batch {
  Primitive primitive;
  void add(const Stage& stage, double x, double y, double z0, double z1, glm::vec4 colour) {
    const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
    const glm::vec3 corners[] = {stage.at(x, y + kCellHeight, z0), stage.at(x + kCellWidth, y + kCellHeight, z1),
                                 stage.at(x + kCellWidth, y, z1), stage.at(x, y, z0)};
    for (const glm::vec3& corner : corners) {
      Vertex vertex{};
      vertex.position = corner;
      vertex.normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
      vertex.colour = colour;
      primitive.vertices.push_back(vertex);
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
  }
};

glm::vec4 colourOf(Random& random) {
  const float bright = random.below(8) ? 1.0f : 100.0f;
  const float coverage = random.below(4) ? random.uniformf() : 1e-4f * random.uniformf();
  return glm::vec4(bright * random.uniformf(), bright * random.uniformf(), 1e-3f * random.uniformf(),
                   std::min(coverage, 0.999f));
}

}  // namespace

Stage stacksScene(std::uint64_t seed) {
  Stage stage(kColumns * kCellWidth, kRows * kCellHeight);
  stage.gbuffer.viewZ = Image<float>(stage.gbuffer.data.width(), stage.gbuffer.data.height(), 500.0f);
  stage.gbuffer.beauty =
      Image<glm::vec4>(stage.gbuffer.data.width(), stage.gbuffer.data.height(), glm::vec4(0.3f, 0.5f, 0.2f, 1.0f));
  Random random(seed);
  Material light = unlitBlend(glm::vec3(1), 1.0f);
  light.additive = true;
  // Solid quads have materials of their own: a solid layer at a random depth would hide most of its stack.
  Batch batches[6];
  const Material materials[] = {
      unlitBlend(glm::vec3(1), 1.0f), glass(0.3f, true), glass(0.6f, false), light, glass(0.0f, false),
      unlitBlend(glm::vec3(1), 1.0f)};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double x = column * kCellWidth, y = row * kCellHeight;
      double z = 1.0;
      const std::uint32_t layers = 1 + random.below(kDeepest);
      for (std::uint32_t i = 0; i < layers; ++i) {
        if (random.below(5)) z = std::pow(10.0, random.between(-2, 2));  // else coplanar with the layer before
        const double other = random.below(3) ? z : z * random.between(0.9, 1.1);
        const std::uint32_t kind = random.below(10);
        Batch& batch = batches[kind < 6 ? 0 : kind - 5];
        const glm::vec4 colour = colourOf(random);
        for (std::uint32_t copies = random.below(6) ? 1 : 2; copies > 0; --copies)
          batch.add(stage, x, y, z, other, colour);
      }
      for (std::uint32_t ties = random.below(4); ties > 0; --ties)
        batches[5].add(stage, x, y, 90.0, 90.0,
                       glm::vec4(random.uniformf(), random.uniformf(), random.uniformf(), 1.0f));
    }
  for (std::size_t i = 0; i < std::size(materials); ++i) {
    batches[i].primitive.material = stage.add(materials[i]);
    stage.place(std::move(batches[i].primitive));
  }
  return stage;
}

}  // namespace pellucid::test
