// A glTF material under a hit: what shaders/gl/material.glsl fetches, fetched on the CPU and handed to the same shared
// text.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "engine_bridge/embree/texture_sampler.h"
#include "engine_bridge/embree/triangle.h"
#include "engine_bridge/scene/blocks.h"
#include "engine_bridge/scene/placed.h"

namespace pellucid::rays {

// Vertex attributes at a hit.
struct Attributes {
  glm::vec3 normal;   // view space, any length
  glm::vec4 tangent;  // the same; w handedness; all 0 for none
  glm::vec2 uv[2];
  glm::vec4 colour;
};
Attributes attributesAt(const Primitive& primitive, const Placed& placed, std::size_t triangle, const TriangleHit& hit);

enum class RimKind { smooth, hard };

class SurfaceSampler {
 public:
  SurfaceSampler(const Scene& scene, TexelFilter filter);

  // Alpha before the mask's cut, base colour, texture and vertex colour together.
  float alphaAt(int material, const Attributes& attributes) const;
  // Where it reads the base colour's texture, in texels.
  glm::vec2 baseTexelAt(int material, const Attributes& attributes) const;
  // Unit, on the side of the eye, normal texture included.
  glm::vec3 normalAt(int material, const Attributes& attributes, bool front, glm::vec3 toEye) const;
  //   alphaWidth  how much alpha changes over one pixel, for the smooth rims of masks
  shading::Surface surfaceAt(int material, const Attributes& attributes, float thicknessScale, bool front, RimKind rim,
                             float alphaWidth) const;

 private:
  glm::vec4 texel(const TextureRef& reference, int slot, const MaterialBlock& block, const Attributes& attributes,
                  TexelWeight weight = TexelWeight::plain) const;
  glm::vec4 baseAt(std::size_t material, const Attributes& attributes) const;

  const Scene& scene_;
  TexelFilter filter_;
  std::vector<MaterialBlock> blocks_;
  std::vector<TexelWeight> weights_;  // of base colours, by material
};

}  // namespace pellucid::rays
