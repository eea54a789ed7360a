// A scene's materials and lights as the shared shading text takes them: what every renderer of ours fills in. The
// material block is also, byte for byte, the one that shaders/gl/material.glsl reads.
#pragma once
#include <cstddef>
#include <vector>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/camera.h"
#include "shaders/shading.h"

namespace pellucid {

struct MaterialBlock {
  glm::vec4 baseColor;
  glm::vec4 emission;    // a: metallic
  glm::vec4 interface_;  // roughness, transmission, ior, alpha cutoff
  glm::vec4 volume;      // attenuation colour; thickness over attenuation distance
  glm::vec4 covering;    // factor on coverage; 1 for additive; scale of normals; roughness that passes through
  glm::vec4 specular;    // tint head-on, strength
  glm::vec4 uvTransforms[16];
  glm::vec4 scattering;  // collimation, < 0: from roughness; diffuse transmission; eta; thickness, object space
  glm::vec4 dispersion;  // eta of red, of blue
  glm::vec4 particle;    // softness, metres; g of its phase function
};
static_assert(sizeof(MaterialBlock) == 25 * 16);

using shading::PunctualLight;
static_assert(sizeof(PunctualLight) == 64);

MaterialBlock materialBlock(const Material& material);
// Interior with a thickness that attenuates: the file's volume unless `thin` says otherwise.
bool hasVolume(const Material& material);
// Whether layers of it bend, or spread, what lies behind them.
bool refracts(const Material& material);
bool diffuses(const Material& material);
// Whether it bends each channel differently.
bool disperses(const Material& material);
// Whether a light sends anything.
bool shines(const Light& light);
// In the camera's view space.
PunctualLight lightBlock(const Light& light, const Camera& camera);
// Lights in the camera's view space. Lights without intensity are left out.
std::vector<PunctualLight> lightBlocks(const std::vector<Light>& lights, const Camera& camera);

}  // namespace pellucid
