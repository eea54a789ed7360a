#include "engine_bridge/gl/solidity.h"

#include <algorithm>
#include <cmath>

#include "engine_bridge/gl/frame_blocks.h"

namespace pellucid::gl {
namespace {

constexpr float kRounding = 1e-5f;   // the shader multiplies in another order
constexpr float kVanishes = 1e-30f;  // a product this small may flush to 0
constexpr float kMirrorIor = 1e4f;   // above it 1 - Fresnel may round to 0

float mostCoverage(const Material& material, const ColourRange& colours, const TexelRange& base) {
  const float factor = material.coverage.value_or(1.0f);
  if (material.alphaMode != AlphaMode::blend) return factor;
  return factor * std::min(1.0f, material.baseColor.a * colours.most.a * base.most.a);
}

// Least transmittance of the volume, one channel.
float leastAttenuation(const Material& material, float colour, float mostThickness, float thicknessScale) {
  if (!hasVolume(material)) return 1.0f;
  const float ratio = material.thickness / material.attenuationDistance * mostThickness * thicknessScale;
  return std::pow(std::clamp(colour, 0.0f, 1.0f), std::max(ratio, 0.0f));
}

}  // namespace

bool canBeSolid(const Material& material, const ColourRange& colours, const SceneTextures& textures,
                float thicknessScale) {
  if (material.additive) return false;
  const TexelRange base = textures.range(material.baseColorTexture.texture);
  if (mostCoverage(material, colours, base) < 1.0f - kRounding) return false;

  const TexelRange transmission = textures.range(material.transmissionTexture.texture);
  if (material.transmission * transmission.least.r <= kVanishes) return true;
  if (!material.unlit) {
    const TexelRange metallic = textures.range(material.metallicRoughnessTexture.texture);
    if (material.metallic * metallic.most.b >= 1.0f - kRounding || material.ior > kMirrorIor) return true;
    // A tinted reflection may leave nothing to enter.
    const bool tinted = material.specularColor != glm::vec3(1.0f) || material.specularColorTexture.texture >= 0;
    if (material.specular > 1.0f - kRounding && tinted) return true;
  }
  const float thickness = textures.range(material.thicknessTexture.texture).most.g;
  for (int channel = 0; channel < 3; ++channel) {
    const float colour = material.baseColor[channel] * colours.least[channel] * base.least[channel];
    const float attenuation = leastAttenuation(material, material.attenuationColor[channel], thickness, thicknessScale);
    if (colour * attenuation > kVanishes) return false;
  }
  return true;
}

bool canTransmitColour(const Material& material, bool vertexColours) {
  const auto isGrey = [](const glm::vec3& colour) { return colour.r == colour.g && colour.g == colour.b; };
  if (material.transmission <= 0.0f) return false;
  if (material.baseColorTexture.texture >= 0 || vertexColours || !isGrey(glm::vec3(material.baseColor))) return true;
  return hasVolume(material) && !isGrey(material.attenuationColor);
}

bool canBeAdditive(const Material& material) {
  return material.additive || material.transmission > 0.0f;
}

}  // namespace pellucid::gl
