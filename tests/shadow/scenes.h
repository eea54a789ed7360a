// Casters and lights that several tests here look at.
#pragma once
#include <cmath>

#include "engine_bridge/scene/scene.h"
#include "shaders/shading.h"

namespace pellucid::test {

inline Material glass(glm::vec3 colour, float ior = 1.0f, bool volume = false) {
  Material material;
  material.name = "glass";
  material.doubleSided = true;
  material.baseColor = glm::vec4(colour, 1.0f);
  material.metallic = 0.0f;
  material.roughness = 0.0f;
  material.transmission = 1.0f;
  material.ior = ior;
  material.volume = volume;
  material.thickness = volume ? 1.0f : 0.0f;
  return material;
}

// A quad in the plane y = height that faces up.
inline Primitive quad(float height, float half) {
  Primitive primitive;
  for (const glm::vec2 at :
       {glm::vec2(-half, half), glm::vec2(half, half), glm::vec2(half, -half), glm::vec2(-half, -half)}) {
    Vertex vertex{};
    vertex.position = {at.x, height, at.y};
    vertex.normal = {0, 1, 0};
    vertex.colour = glm::vec4(1.0f);
    primitive.vertices.push_back(vertex);
  }
  primitive.indices = {0, 1, 2, 0, 2, 3};
  return primitive;
}

inline Primitive sphere(glm::vec3 centre, float radius) {
  constexpr int rings = 96, steps = 192;
  Primitive primitive;
  for (int ring = 0; ring <= rings; ++ring)
    for (int step = 0; step <= steps; ++step) {
      const double theta = M_PI * ring / rings, phi = 2 * M_PI * step / steps;
      Vertex vertex{};
      vertex.normal = {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                       static_cast<float>(-std::sin(theta) * std::sin(phi))};
      vertex.position = centre + radius * vertex.normal;
      vertex.colour = glm::vec4(1.0f);
      primitive.vertices.push_back(vertex);
    }
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t step = 0; step < steps; ++step) {
      const std::uint32_t a = ring * (steps + 1) + step, b = a + 1, c = a + steps + 1, d = c + 1;
      for (const std::uint32_t i : {a, c, b, b, c, d}) primitive.indices.push_back(i);
    }
  return primitive;
}

inline void add(Scene& scene, const Primitive& primitive, const Material& material) {
  Instance instance;
  instance.primitive = static_cast<int>(scene.primitives.size());
  // Not of the range of triangles: identityOf() hashes both alike.
  instance.identity = shading::hashOf(0x10000u + static_cast<std::uint32_t>(scene.instances.size()));
  scene.primitives.push_back(primitive);
  scene.primitives.back().material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  scene.instances.push_back(instance);
}

inline Light sun(glm::dvec3 direction) {
  Light light;
  light.name = "sun";
  light.kind = LightKind::directional;
  light.intensity = 1.0f;
  light.direction = glm::normalize(direction);
  return light;
}

}  // namespace pellucid::test
