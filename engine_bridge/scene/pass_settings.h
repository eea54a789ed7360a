// What a pass over transparent geometry is asked for, split by who reads it. GL, rays and the sampler share these.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "engine_bridge/scene/light_volume.h"
#include "engine_bridge/scene/scene.h"
#include "engine_bridge/scene/surroundings.h"
#include "gbuffer/occluders.h"

namespace pellucid {

struct ShadowMaps;  // gbuffer/shadow_maps.h

enum class TextureFilter { mipmap, bilinear, nearest };
enum class MaskEdge { smooth, hard };

// Order in which triangles are submitted. Only for tests: no result may depend on it beyond float rounding.
struct SubmissionOrder {
  enum Kind { file, reverse, shuffle } kind = file;
  std::uint64_t seed = 0;
};

// What refraction and diffusion are computed from. MODEL sections 4, 5
struct ScatterSettings {
  int refract = shading::PLD_REFRACT_DEPTH;  // PLD_REFRACT_*
  float refractDistance = 2.0f;              // metres, fixed mode
  float k0 = 0.3f, k1 = 0.5f;                // metres; k0 = 0 leaves diffusion out
  bool dispersion = true;                    // materials that disperse have one index per channel
  bool netCoverage = false;                  // the published listing's factor, which loses clear frosted glass
  bool prune = true;                         // leave out what the scene's materials do not have; changes no bit
};

// Ambient occlusion of cut-out surfaces: of what they cover wholly by its own pixel, of rims by the pixels beside them.
// MODEL section 10
struct OcclusionSettings {
  std::shared_ptr<const OccluderPlanes> occluders;  // of the data window; null: nothing is occluded
  bool rims = true;                                 // false leaves rims open
  int form = shading::PLD_OCCLUSION_RELATIVE;       // PLD_OCCLUSION_*
  float directShare = 0.0f;                         // how much of it darkens direct light too, [0,1]
};

// What the sums are kept in. DESIGN, Precision tiers; `exact` is fragments() and a fold.
enum class SumsTier { float32, published };

// Which materials of a scene are drawn: all, or those that are marked lowResolution, or the others.
enum class LayerChoice { all, fullResolution, lowResolution };
inline bool takes(LayerChoice choice, const Material& material) {
  return choice == LayerChoice::all || (choice == LayerChoice::lowResolution) == material.lowResolution;
}

// Where and how finely the picture is sampled.
struct ViewSettings {
  glm::dvec2 sample{0.5, 0.5};  // where in the pixel, y down; (0.5, 0.5) is the centre
  // Edge of the square that this sample stands for, pixels: 1 for the pixel's only one, 1 / sqrt(N) for one of N whose
  // mean is taken. Rims of masks and texture footprints are that wide, so that the mean filters by the pixel, once.
  float footprint = 1.0f;
  int probeCell = 1;  // above 1, lists hold one pixel of every cell of this edge alone: shaders/shared/probe.glsl
  // The part of the data window that is drawn and listed, display coordinates; all of it where it is empty. What lies
  // beyond stays as nothing has left it; inside, no bit depends on it.
  Window area = {};
};

// What a fragment's colour, coverage and scattering are computed from.
struct ShadingSettings {
  // Identities of lists and stochastic samples name the piece of the triangle, about a pixel large, that lies in the
  // pixel's middle, instead of the triangle: shaders/shared/piece.glsl.
  bool pieces = false;
  TextureFilter filter = TextureFilter::mipmap;
  MaskEdge mask = MaskEdge::smooth;
  LayerChoice layers = LayerChoice::all;
  glm::vec3 surroundings{0.0f};                     // constant environment radiance, scene-linear
  std::shared_ptr<const Surroundings> environment;  // a picture of them, which wins over the constant
  ScatterSettings scatter;
  OcclusionSettings occlusion;
  // What is in the way of the scene's lights, for maps made with this camera; null: nothing is.
  std::shared_ptr<const ShadowMaps> shadows = nullptr;
  // The same, asked for every fragment of lit surfaces that are not particles, instead of maps.
  std::shared_ptr<const SurfaceVisibility> shadowRays = nullptr;
  std::shared_ptr<const LightVolume> particleLight;  // what of the lights reaches particles; null: all of them do
  std::shared_ptr<const Fog> fog;  // marched in front of what is opaque, into the sums; lists leave it to their reader
};

// What is kept in memory, and in which order geometry comes. Changes no bit of exact sums and lists.
struct ResidencySettings {
  SubmissionOrder order;
  std::size_t budgetBytes = std::size_t{256} << 20;  // geometry, and for lists fragments, resident at once
  std::size_t chunkBytes = 0;                        // geometry of one chunk; 0: what the budget leaves. For tests
  int tile = 0;                                      // scissor tiles of this edge in pixels; 0 picks one
};

// How layers are summed; lists do not read it.
struct SumsSettings {
  SumsTier tier = SumsTier::float32;
  shading::WeightSettings weight{shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f};
  int normalisation = shading::PLD_NORMALISE_SPECTRAL;
};

struct PassSettings : SumsSettings, ViewSettings, ShadingSettings, ResidencySettings {};

// What a pass draws of a data window.
inline const Window& areaOf(const ViewSettings& settings, const Window& data) {
  return settings.area.width() > 0 && settings.area.height() > 0 ? settings.area : data;
}

}  // namespace pellucid
