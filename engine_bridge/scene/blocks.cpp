#include "engine_bridge/scene/blocks.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

void putTransform(MaterialBlock& block, std::size_t slot, const TextureRef& reference) {
  const glm::mat3& m = reference.uvTransform;  // columns
  block.uvTransforms[2 * slot] = {m[0][0], m[1][0], m[2][0], static_cast<float>(reference.texCoord)};
  block.uvTransforms[2 * slot + 1] = {m[0][1], m[1][1], m[2][1], 0.0f};
}

// Facets of an index of 1 bend nothing, however rough; from 1.5 on roughness counts in full, as in Khronos' viewer,
// which glTF's authors look at.
float roughnessThrough(float ior) {
  return std::clamp(2.0f * ior - 2.0f, 0.0f, 1.0f);
}

}  // namespace

bool hasVolume(const Material& material) {
  return material.hasInterior() && material.thickness > 0.0f && material.attenuationDistance > 0.0f;
}

bool refracts(const Material& material) {
  return material.hasInterior() && !material.unlit && material.transmission > 0.0f && material.ior != 1.0f;
}

bool disperses(const Material& material) {
  return refracts(material) && material.dispersion > 0.0f;
}

bool diffuses(const Material& material) {
  if (material.collimation) return *material.collimation < 1.0f;
  return !material.unlit && material.transmission > 0.0f &&
         (material.roughness * roughnessThrough(material.ior) > 0.0f || material.diffuseTransmission > 0.0f);
}

MaterialBlock materialBlock(const Material& material) {
  MaterialBlock block{};
  block.baseColor = material.baseColor;
  block.emission = glm::vec4(material.emission, material.metallic);
  block.interface_ = {material.roughness, material.transmission, material.ior, material.alphaCutoff};
  block.volume = glm::vec4(material.attenuationColor,
                           hasVolume(material) ? material.thickness / material.attenuationDistance : 0.0f);
  block.covering = {material.coverage.value_or(1.0f), material.additive ? 1.0f : 0.0f, material.normalScale,
                    roughnessThrough(material.ior)};
  block.specular = glm::vec4(material.specularColor, material.specular);
  const float eta = refracts(material) ? 1.0f / material.ior : 1.0f;
  const glm::vec3 etas =
      disperses(material) ? shading::dispersedEta(material.ior, material.dispersion) : glm::vec3(eta);
  block.dispersion = {etas.r, etas.b, 0.0f, 0.0f};
  block.particle = {material.softness, material.phase, 0.0f, 0.0f};
  // One that states no collimation and does not diffuse is clear.
  block.scattering = {material.collimation ? *material.collimation
                      : diffuses(material) ? -1.0f
                                           : 1.0f,
                      material.diffuseTransmission, eta, material.thickness};
  const auto references = material.textures();
  for (std::size_t slot = 0; slot < references.size(); ++slot) putTransform(block, slot, *references[slot]);
  return block;
}

bool shines(const Light& light) {
  return light.colour * light.intensity != glm::vec3(0.0f);
}

PunctualLight lightBlock(const Light& light, const Camera& camera) {
  PunctualLight block{};
  block.position = glm::vec4(glm::vec3(camera.viewFromWorld * glm::dvec4(light.position, 1.0)), light.range);
  const float kind = light.kind == LightKind::directional ? 0.0f : light.kind == LightKind::point ? 1.0f : 2.0f;
  const glm::dvec3 direction = glm::dmat3(camera.viewFromWorld) * light.direction;
  block.direction = glm::vec4(glm::vec3(glm::normalize(direction)), kind);
  block.intensity = glm::vec4(light.colour * light.intensity, 0.0f);
  // KHR_lights_punctual, "Inner and Outer Cone Angles".
  const double cosInner = std::cos(static_cast<double>(light.innerCone));
  const double cosOuter = std::cos(static_cast<double>(light.outerCone));
  const double scale = 1.0 / std::max(0.001, cosInner - cosOuter);
  block.cone = {static_cast<float>(scale), static_cast<float>(-cosOuter * scale), 0.0f, 0.0f};
  return block;
}

std::vector<PunctualLight> lightBlocks(const std::vector<Light>& lights, const Camera& camera) {
  std::vector<PunctualLight> blocks;
  for (const Light& light : lights)
    if (shines(light)) blocks.push_back(lightBlock(light, camera));
  return blocks;
}

}  // namespace pellucid
