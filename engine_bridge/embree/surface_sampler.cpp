#include "engine_bridge/embree/surface_sampler.h"

#include "engine_bridge/scene/foliage.h"

namespace pellucid::rays {
Attributes attributesAt(const Primitive& primitive, const Placed& placed, std::size_t triangle,
                        const TriangleHit& hit) {
  const Vertex* corners[3];
  for (std::size_t i = 0; i < 3; ++i) corners[i] = &primitive.vertices[primitive.indices[3 * triangle + i]];
  // From the first corner on: what is the same at all three stays what it is, to the bit. Full coverage is solid.
  const float second = static_cast<float>(hit.weight[1]), third = static_cast<float>(hit.weight[2]);
  const auto between = [&](auto member) {
    const auto start = member(*corners[0]);
    return start + second * (member(*corners[1]) - start) + third * (member(*corners[2]) - start);
  };
  Attributes result;
  const glm::vec3 normal = between([](const Vertex& vertex) { return vertex.normal; });
  result.uv[0] = between([](const Vertex& vertex) { return vertex.uv[0]; });
  result.uv[1] = between([](const Vertex& vertex) { return vertex.uv[1]; });
  result.colour = between([](const Vertex& vertex) { return vertex.colour; }) * placed.colour;
  result.normal = placed.normalFromObject * normal;
  result.tangent = glm::vec4(0.0f);
  if (corners[0]->tangent != glm::vec2(0.0f)) {
    const glm::vec4 tangent = between([](const Vertex& vertex) { return shading::unpackTangent(vertex.tangent); });
    result.tangent = glm::vec4(glm::mat3(placed.viewFromObject) * glm::vec3(tangent), tangent.w);
  }
  return result;
}

SurfaceSampler::SurfaceSampler(const Scene& scene, TexelFilter filter) : scene_(scene), filter_(filter) {
  for (const Material& material : scene.materials) {
    blocks_.push_back(materialBlock(material));
    weights_.push_back(weighsByAlpha(material, scene) ? TexelWeight::byAlpha : TexelWeight::plain);
  }
}

namespace {

glm::vec2 uvOf(const TextureRef& reference, int slot, const MaterialBlock& block, const Attributes& attributes) {
  const glm::vec4 u = block.uvTransforms[2 * slot], v = block.uvTransforms[2 * slot + 1];
  const glm::vec3 uv1(attributes.uv[reference.texCoord == 0 ? 0 : 1], 1.0f);
  return {glm::dot(glm::vec3(u), uv1), glm::dot(glm::vec3(v), uv1)};
}

}  // namespace

glm::vec4 SurfaceSampler::texel(const TextureRef& reference, int slot, const MaterialBlock& block,
                                const Attributes& attributes, TexelWeight weight) const {
  return sampleTexture(scene_.textures[static_cast<std::size_t>(reference.texture)],
                       uvOf(reference, slot, block, attributes), filter_, weight);
}

glm::vec4 SurfaceSampler::baseAt(std::size_t index, const Attributes& attributes) const {
  const Material& material = scene_.materials[index];
  const MaterialBlock& block = blocks_[index];
  glm::vec4 base = block.baseColor * attributes.colour;
  if (material.baseColorTexture.texture >= 0)
    base *= texel(material.baseColorTexture, 0, block, attributes, weights_[index]);
  return base;
}

float SurfaceSampler::alphaAt(int material, const Attributes& attributes) const {
  return baseAt(static_cast<std::size_t>(material), attributes).a;
}

glm::vec2 SurfaceSampler::baseTexelAt(int index, const Attributes& attributes) const {
  const Material& material = scene_.materials[static_cast<std::size_t>(index)];
  if (material.baseColorTexture.texture < 0) return glm::vec2(0.0f);
  const Image<glm::vec4>& texels = scene_.textures[static_cast<std::size_t>(material.baseColorTexture.texture)].texels;
  return uvOf(material.baseColorTexture, 0, blocks_[static_cast<std::size_t>(index)], attributes) *
         glm::vec2(texels.width(), texels.height());
}

glm::vec3 SurfaceSampler::normalAt(int index, const Attributes& attributes, bool front, glm::vec3 toEye) const {
  const Material& material = scene_.materials[static_cast<std::size_t>(index)];
  const MaterialBlock& block = blocks_[static_cast<std::size_t>(index)];
  if (material.normalTexture.texture < 0) return shading::normalTowardsEye(attributes.normal, front, toEye);
  const glm::vec3 found(texel(material.normalTexture, 5, block, attributes));
  return shading::bumpedTowardsEye(attributes.normal, attributes.tangent, found, block.covering.b, front, toEye);
}

shading::Surface SurfaceSampler::surfaceAt(int index, const Attributes& attributes, float thicknessScale, bool front,
                                           RimKind rim, float alphaWidth) const {
  const Material& material = scene_.materials[static_cast<std::size_t>(index)];
  const MaterialBlock& block = blocks_[static_cast<std::size_t>(index)];
  shading::MaterialPoint point;
  point.base = baseAt(static_cast<std::size_t>(index), attributes);
  point.emission = glm::vec3(block.emission);
  point.metallic = block.emission.a;
  point.roughness = block.interface_.r;
  point.transmission = block.interface_.g;
  point.ior = block.interface_.b;
  point.specular = block.specular;
  if (material.specularTexture.texture >= 0)
    point.specular.a *= texel(material.specularTexture, 6, block, attributes).a;
  if (material.specularColorTexture.texture >= 0)
    point.specular *= glm::vec4(glm::vec3(texel(material.specularColorTexture, 7, block, attributes)), 1.0f);
  if (material.metallicRoughnessTexture.texture >= 0) {
    const glm::vec4 value = texel(material.metallicRoughnessTexture, 1, block, attributes);
    point.roughness *= value.g;
    point.metallic *= value.b;
  }
  if (material.emissiveTexture.texture >= 0)
    point.emission *= glm::vec3(texel(material.emissiveTexture, 2, block, attributes));
  if (material.transmissionTexture.texture >= 0)
    point.transmission *= texel(material.transmissionTexture, 3, block, attributes).r;
  glm::vec3 attenuation(1.0f);
  // What enters on a front face leaves through a back face: counted once.
  if (front && material.transmission > 0.0f && hasVolume(material)) {
    float ratio = block.volume.a * thicknessScale;
    if (material.thicknessTexture.texture >= 0) ratio *= texel(material.thicknessTexture, 4, block, attributes).g;
    attenuation = shading::attenuationOf(glm::vec3(block.volume), ratio);
  }
  float coverage = 1.0f;
  if (material.alphaMode == AlphaMode::blend) coverage = glm::clamp(point.base.a, 0.0f, 1.0f);
  if (material.alphaMode == AlphaMode::mask)
    coverage = rim == RimKind::smooth ? shading::maskCoverage(point.base.a, material.alphaCutoff, alphaWidth)
                                      : (point.base.a >= material.alphaCutoff ? 1.0f : 0.0f);
  return shading::surfaceOf(point, coverage * block.covering.r, attenuation, material.unlit);
}

}  // namespace pellucid::rays
