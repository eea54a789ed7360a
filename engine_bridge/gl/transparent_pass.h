// Streams a scene's transparent triangles, in any order, through GL: into OIT planes, or into exact fragment lists.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "engine_bridge/scene/pass_settings.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/lean_lists.h"
#include "gbuffer/published.h"
#include "gbuffer/rim_planes.h"

namespace pellucid {

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
  // The scene that it was made with has been posed anew, or the camera has moved; over() says which picture it sees.
  void pose(const Camera& camera);
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
