// Sums to picture on the device, from the text that the CPU resolves by: for engines whose planes are there already.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "engine_bridge/gl/transparent_pass.h"
#include "shaders/plane_layout.h"

namespace pellucid {

struct DeviceResolveSettings {
  bool selfModulation = false;                 // PT17 eq. 14
  int kernel = shading::PLD_DIFFUSE_GAUSSIAN;  // PLD_DIFFUSE_*
  bool exact = false;                          // every tap of the Gaussian, at a cost that grows as D^2
  bool published = false;                      // the planes are those of records in the published tier
};

// GL names of 2D textures of one size, row 0 the top row.
struct ResolveTextures {
  // The planes of MODEL section 3 as shaders/shared packs them: what the targets of a transparent pass over such layers
  // are. By PlaneSum; those that planesOf(layers) has.
  LayerModel layers;
  std::array<std::uint32_t, static_cast<std::size_t>(PlaneSum::nearestZ) + 1> planes{};
  std::uint32_t solid = 0;       // RGBA32F; rgb, planar z, +inf for none
  std::uint32_t background = 0;  // RGBA, scene-linear, premultiplied, and alpha
  std::uint32_t opaqueZ = 0;     // R32F, planar metres, +inf for nothing
};

// What transparency does to a picture, see composite/veil.h: picture = light + transmission * background, or where
// `kind` is 2, light + applied.
struct DeviceVeil {
  Image<glm::vec4> light;         // rgb; a: kind: 0 untouched, 1 shows its own background, 2 another
  Image<glm::vec4> transmission;  // rgb
  Image<glm::vec4> applied;       // rgb; a: mean transmission times (1 - that background's alpha)
};

class ResolvePass {
 public:
  explicit ResolvePass(GlContext& context);
  ~ResolvePass();

  // Draws into the framebuffer's first three colour attachments, RGBA32F (see shaders/gl/resolve.frag), over
  // (0, 0)-(width, height). Leaves the clip origin at the upper left, blending, depth and scissor tests off.
  //   largestVariance  of the refraction plane's s^2, pixels^2: how deep a pyramid is needed
  void draw(const ResolveTextures& textures, int width, int height, float largestVariance,
            const DeviceResolveSettings& settings, std::uint32_t framebuffer);

  // The same from records and back. Throws ResourceError where the device has no room for them.
  DeviceVeil resolve(const OitPlanes& planes, const GBuffer& background, const DeviceResolveSettings& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
