// The shared text of the march in C++, and the rays of a picture that it goes along.
#pragma once
#include <memory>

#include "gbuffer/gbuffer.h"
#include "gbuffer/medium.h"

namespace pellucid {
namespace shading {

// The shared text of the march, with the functions by which it reads volumes.
struct MarchText {
  const Fog& fog;
  ivec3 gridSize;
  bool hasVisibility;
  mat4 volumeFromView;
  int lightsOfFog;

  explicit MarchText(const Fog& given)
      : fog(given),
        gridSize(given.grid ? given.grid->density.size : ivec3(1)),
        hasVisibility(given.visibility != nullptr),
        volumeFromView(given.visibility ? given.visibility->texelFromView : mat4(1.0f)),
        lightsOfFog(static_cast<int>(given.lights.size())) {}
  float densityTexel(ivec3 texel) const { return fog.grid->density.clamped(texel); }
  vec3 emissionTexel(ivec3 texel) const { return vec3(fog.grid->emission.clamped(texel)); }
  vec3 visibilityTexel(int light, ivec3 texel) const {
    const LightVolume& volume = *fog.visibility;
    const ivec3 inside = clamp(texel, ivec3(0), volume.size - 1);
    return vec3(volume.visibility.at(ivec3(inside.x, inside.y, inside.z + light * volume.size.z)));
  }
  const PunctualLight& lightNumber(int light) const { return fog.lights[static_cast<std::size_t>(light)]; }

#define PLD_FN inline
#define precise
#include "shaders/shared/march.glsl"
#undef precise
#undef PLD_FN
};

}  // namespace shading

// The rays of one picture through one fog.
struct FogMarcher {
  const Fog& fog;
  std::unique_ptr<shading::MarchText> text;
  PixelRays rays;

  FogMarcher(const Fog& given, const GBuffer& gbuffer, const Window& window, glm::dvec2 sample)
      : fog(given),
        text(new shading::MarchText(given)),
        rays(pixelRays(given.camera, gbuffer.display, {window.x0, window.y0}, sample)) {}

  shading::FogSpan span(int x, int y, float z) const {
    const glm::vec2 at = rays.offset + rays.scale * glm::vec2(static_cast<float>(x), static_cast<float>(y));
    return shading::spanOfPixel(fog.medium, at, rays.orthographic ? 1 : 0, z);
  }
  // What a whole ray spreads.
  shading::FogSpread spread(const shading::FogSpan& span, float behind) const {
    const shading::WeightSettings uniform{shading::PLD_WEIGHT_UNIFORM, 0.1f, 1000.0f, 1.0f, 1.0f};
    return shading::fogSpread(fog.medium, text->marchFog(fog.medium, span, uniform, shading::PLD_FOG_ORDERED),
                              fog.diffusion, behind);
  }
};

}  // namespace pellucid
