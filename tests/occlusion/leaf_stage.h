// Cards with binary masks as the GL pass takes them.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "composite/resolve.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "samples/foliage/plants.h"

namespace pellucid::test {

struct LeafStage {
  Scene scene;
  GBuffer gbuffer;
  Camera camera;

  LeafStage(const Window& display, const Window& data, const Camera& given) : camera(given) {
    gbuffer.display = display;
    gbuffer.data = data;
    gbuffer.viewZ = Image<float>(data.width(), data.height(), std::numeric_limits<float>::infinity());
    gbuffer.beauty = Image<glm::vec4>(data.width(), data.height(), glm::vec4(0.0f));
    gbuffer.depthPrecision = 1e-5f;
  }

  // White, of ambient reflectance 1 but for Fresnel; cut at 1/2.
  int addMask(Image<glm::vec4> texels) {
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec4(1.0f, 1.0f, 1.0f, texels[i].a);
    Texture texture;
    texture.name = "mask";
    texture.texels = std::move(texels);
    texture.wrapS = texture.wrapT = Wrap::clamp;
    scene.textures.push_back(std::move(texture));
    Material material;
    material.name = "leaf";
    material.alphaMode = AlphaMode::mask;
    material.doubleSided = true;
    material.metallic = 0.0f;
    material.baseColorTexture.texture = static_cast<int>(scene.textures.size()) - 1;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
  }

  void addCards(const std::vector<samples::Card>& cards, int material) {
    Primitive primitive;
    primitive.material = material;
    for (const samples::Card& card : cards) {
      const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
      const std::pair<glm::dvec3, glm::vec2> corners[] = {{card.corner, {0, 1}},
                                                          {card.corner + card.right, {1, 1}},
                                                          {card.corner + card.right + card.up, {1, 0}},
                                                          {card.corner + card.up, {0, 0}}};
      for (const auto& [position, uv] : corners) {
        Vertex vertex{};
        vertex.position = glm::vec3(position);
        vertex.normal = glm::vec3(glm::normalize(glm::cross(card.right, card.up)));
        vertex.uv[0] = vertex.uv[1] = uv;
        vertex.colour = glm::vec4(1.0f);
        primitive.vertices.push_back(vertex);
      }
      for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
    }
    Instance instance;
    instance.primitive = static_cast<int>(scene.primitives.size());
    instance.identity = 1000u * static_cast<std::uint32_t>(scene.instances.size() + 1);
    scene.primitives.push_back(std::move(primitive));
    scene.instances.push_back(instance);
  }

  OitPlanes accumulate(const PassSettings& settings) const {
    GlContext context;
    TransparentPass pass(context, scene, gbuffer, camera);
    return pass.accumulate(settings);
  }
  Veil veil(const PassSettings& settings) const { return resolve(accumulate(settings), {}); }
};

}  // namespace pellucid::test
