// Streams a scene's transparent triangles, in any order, through GL: into OIT planes, or into exact fragment lists.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "engine_bridge/scene/light_volume.h"
#include "engine_bridge/scene/scene.h"
#include "engine_bridge/scene/surroundings.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/lean_lists.h"
#include "gbuffer/occluders.h"
#include "gbuffer/published.h"
#include "gbuffer/rim_planes.h"

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

struct PassSettings {
  SumsTier tier = SumsTier::float32;
  shading::WeightSettings weight{shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f};
  int normalisation = shading::PLD_NORMALISE_SPECTRAL;
  glm::dvec2 sample{0.5, 0.5};  // where in the pixel, y down; (0.5, 0.5) is the centre
  // Edge of the square that this sample stands for, pixels: 1 for the pixel's only one, 1 / sqrt(N) for one of N whose
  // mean is taken. Rims of masks and texture footprints are that wide, so that the mean filters by the pixel, once.
  float footprint = 1.0f;
  TextureFilter filter = TextureFilter::mipmap;
  MaskEdge mask = MaskEdge::smooth;
  SubmissionOrder order;
  std::size_t budgetBytes = std::size_t{256} << 20;  // geometry, and for lists fragments, resident at once
  std::size_t chunkBytes = 0;                        // geometry of one chunk; 0: what the budget leaves. For tests
  int tile = 0;                                      // scissor tiles of this edge in pixels; 0 picks one
  glm::vec3 surroundings{0.0f};                      // constant environment radiance, scene-linear
  std::shared_ptr<const Surroundings> environment;   // a picture of them, which wins over the constant
  ScatterSettings scatter;
  OcclusionSettings occlusion;
  // What is in the way of the scene's lights, for maps made with this camera; null: nothing is.
  std::shared_ptr<const ShadowMaps> shadows = nullptr;
  // The same, asked for every fragment of lit surfaces that are not particles, instead of maps.
  std::shared_ptr<const SurfaceVisibility> shadowRays = nullptr;
  LayerChoice layers = LayerChoice::all;
  int probeCell = 1;  // above 1, lists hold one pixel of every cell of this edge alone: shaders/shared/probe.glsl
  std::shared_ptr<const LightVolume> particleLight;  // what of the lights reaches particles; null: all of them do
  std::shared_ptr<const Fog> fog;  // marched in front of what is opaque, into the sums; lists leave it to their reader
};

struct PassStatistics {
  std::size_t triangles = 0, chunks = 0, tiles = 0, fragments = 0;
  double seconds = 0;
  int bitsPerPixel = 0;             // of the planes that were accumulated
  int solidBits = 0;                // a pixel, of the solid pass
  int passes = 0;                   // over the geometry
  std::vector<std::string> pruned;  // what was left out, and why
  PublishedClamps clamps;           // tier published
  std::size_t shadowRays = 0;       // one for each light and fragment that PassSettings::shadowRays was asked for
  double shadowSeconds = 0;         // of which `seconds` counts these too
};

// A headless GL 4.5 core context: EGL surfaceless, else EGL device. Throws ResourceError when there is none.
class GlContext {
 public:
  explicit GlContext(int device = -1);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  std::string description() const;  // renderer and version

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// One line per EGL device, for `inspect --devices`.
std::vector<std::string> listDevices();

class TransparentPass {
 public:
  // Uploads textures and the G-buffer's Z; geometry is streamed. The arguments must outlive the pass.
  TransparentPass(GlContext& context, const Scene& scene, const GBuffer& gbuffer, const Camera& camera);
  ~TransparentPass();

  // Solid pass, then the sums. May be called again with another sample position.
  OitPlanes accumulate(const PassSettings& settings);

  // Exact lists of every transparent fragment in front of the G-buffer and of the nearest solid, tile by tile, top to
  // bottom; together the tiles cover the data window. Fragments of a pixel are in no order.
  void fragments(const PassSettings& settings, const std::function<void(const FragmentLists&)>& tile);
  // The same without what scatters and without identities, for less of the memory's traffic, in blocks of any order;
  // the lists hold until `tile` returns.
  void leanFragments(const PassSettings& settings, const std::function<void(const LeanLists&)>& tile);

  // Whether some material of the scene is cut out, lit by surroundings, and has rims to infer occlusion for.
  bool wantsOccluders(const PassSettings& settings) const;
  // Depth of the nearest fragment that hides everything, at pixel centres, of the data window: planar metres, +inf for
  // none. What the occluders of such a pass are made from.
  Image<float> solidDepth(const PassSettings& settings);
  // What accumulate() has left open of the rims when the settings' occlusion has no rims: their light from around, at
  // the same sample. Empty when the settings have no occluders, or no leaf wants some.
  RimPlanes rims(const PassSettings& settings);
  // From now on draws over another picture, whose camera stands where the first one stood; both must outlive the pass.
  // What a low-resolution pass draws over.
  void over(const GBuffer& gbuffer, const Camera& camera);

  // Whether planes and fragments of such a pass carry refraction or diffusion.
  bool scatters(const PassSettings& settings) const;

  const PassStatistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Replays fragment lists through the same fixed-function blending, in list order: the parity test's GL voice.
OitPlanes replayFragments(GlContext& context, const FragmentLists& lists, const shading::WeightSettings& weight,
                          int normalisation);

}  // namespace pellucid
