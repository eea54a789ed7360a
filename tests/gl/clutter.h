// A scene with everything at once: overlapping meshes and instances, textures, lights, solids, glass, masks.
#pragma once
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {

inline Primitive scatteredTriangles(const Stage& stage, Random& random, int count, int material) {
  Primitive primitive;
  primitive.material = material;
  const double width = stage.gbuffer.display.width(), height = stage.gbuffer.display.height();
  for (int i = 0; i < count; ++i) {
    const double x = random.between(0, width), y = random.between(0, height), z = random.between(1, 20);
    for (int corner = 0; corner < 3; ++corner) {
      Vertex vertex{};
      vertex.position =
          stage.at(x + random.between(-12, 12), y + random.between(-12, 12), z + random.between(-0.5, 0.5));
      vertex.normal =
          glm::normalize(glm::vec3(random.between(-0.4, 0.4), random.between(-0.4, 0.4), random.between(0.5, 1)));
      vertex.uv[0] =
          vertex.uv[1] = {static_cast<float>(random.between(0, 3)), static_cast<float>(random.between(0, 3))};
      vertex.colour = glm::vec4(random.uniformf(), random.uniformf(), random.uniformf(), 1.0f);
      primitive.indices.push_back(static_cast<std::uint32_t>(primitive.vertices.size()));
      primitive.vertices.push_back(vertex);
    }
    // Every other triangle shares an edge with the one before it.
    if (i % 2 == 1) {
      primitive.indices[primitive.indices.size() - 3] = primitive.indices[primitive.indices.size() - 5];
      primitive.indices[primitive.indices.size() - 2] = primitive.indices[primitive.indices.size() - 4];
    }
  }
  return primitive;
}

inline Stage clutter(int width, int height, int trianglesEach) {
  Stage stage(width, height);
  Random random(11);
  std::vector<glm::vec4> texels;
  for (int i = 0; i < 64; ++i)
    texels.emplace_back(random.uniformf(), random.uniformf(), random.uniformf(), random.uniformf());
  const int noise = stage.texture(8, 8, texels);

  Material smoke = unlitBlend({0.8f, 0.7f, 0.6f}, 0.3f);
  smoke.baseColorTexture.texture = noise;
  Material leaf = unlitBlend({0.2f, 0.7f, 0.3f}, 1.0f);
  leaf.unlit = false;
  leaf.metallic = 0.0f;
  leaf.alphaMode = AlphaMode::mask;
  leaf.baseColorTexture.texture = noise;
  Material glass;
  glass.doubleSided = true;
  glass.transmission = 0.9f;
  glass.metallic = 0.0f;
  glass.roughness = 0.2f;
  glass.baseColor = {0.9f, 0.95f, 0.7f, 1.0f};
  Material flame = unlitBlend({3.0f, 1.0f, 0.2f}, 0.5f);
  flame.additive = true;
  for (const Material& material : {smoke, leaf, glass, flame}) {
    const int index = stage.add(material);
    stage.place(scatteredTriangles(stage, random, trianglesEach, index));
    // Instances of the same primitive, one of them mirrored.
    Instance shifted = stage.scene.instances.back();
    shifted.worldFromObject[3] = glm::dvec4(0.3, -0.2, -1.5, 1.0);
    shifted.identity += 1;
    stage.scene.instances.push_back(shifted);
    shifted.worldFromObject = glm::dmat4(1.0);
    shifted.worldFromObject[0][0] = -1.0;
    shifted.identity += 1;
    stage.scene.instances.push_back(shifted);
  }
  Light sun;
  sun.kind = LightKind::directional;
  sun.intensity = 2.0f;
  sun.direction = glm::normalize(glm::dvec3(0.2, -0.5, -1));
  Light bulb;
  bulb.intensity = 5.0f;
  bulb.position = {1, 1, -3};
  stage.scene.lights = {sun, bulb};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width / 3; ++x) stage.gbuffer.viewZ.at(x, y) = 9.0f;
  return stage;
}

}  // namespace pellucid::test
