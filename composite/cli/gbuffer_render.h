// The two renderers behind `gbuffer`.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/blur_flags.h"
#include "composite/cli/colour_flags.h"
#include "composite/cli/options.h"
#include "composite/cli/preview_flags.h"
#include "composite/cli/sequence_flags.h"
#include "composite/cli/time_flags.h"
#include "composite/pipeline/journal.h"
#include "engine_bridge/scene/opaque_planes.h"
#include "engine_bridge/scene/scene.h"
#include "gbuffer/colour_space.h"

namespace pellucid::cli {

struct GbufferFlags {
  std::vector<std::string> scenes;
  std::string output, renderer = "embree", size, camera, environment, shadows, textureFilter, assetRoot, filter;
  std::optional<int> samples, passes;
  std::optional<double> aoRadius;
  std::vector<std::string> overrides;
  double unit = 1.0, lumensPerWatt = 683.0;
  int device = -1;
  TimeFlags time;
  BlurFlags blur;
  ColourFlags colour;
  PreviewFlags preview;
  RunFlags run;
  SequenceFlags sequence;
};

// The opaque part of a scene, rendered.
struct RenderedPart {
  OpaquePlanes planes;
  Camera camera;
  ColourSpace space;
  Window window;
  std::ptrdiff_t opaqueInstances = 0;
  std::size_t triangles = 0;
  std::size_t lights = 0;  // that shine
  std::string device = "Embree";
};

// Reads the scenes and renders what is opaque in them, saying what was inferred. Throws UsageError for flags that do
// not go together, and what readers throw.
//   fits  where nobody names a camera and the scenes have none, one is made that frames them
//   told  the share of a traced picture that is done; may be null
RenderedPart renderPart(const GbufferFlags& flags, bool fits, Stages& stages,
                        const std::function<void(double)>& told = nullptr);
// Writes it, and says the notes.
//   attributes  for its header, beside the renderer's name
void writePart(const std::string& path, const RenderedPart& part, const std::string& renderer,
               std::map<std::string, std::string> attributes = {});

// The animations of scenes that have no picture yet, whose header could name its frame. Returns when they are played.
// Throws UsageError.
std::optional<ShotMoment> playAnimations(const ShotTime& time, SceneOptions& options);
Window parseSize(const std::string& text);  // "1920x1080"; throws UsageError

// The attributes with those of the filter, where it is not the pixel's square, of the frame and of the shutter.
std::map<std::string, std::string> withSettings(const GbufferFlags& flags,
                                                std::map<std::string, std::string> attributes);
// What needs no scene: that the renderer honours the flags. Throws UsageError.
void checkFlags(const GbufferFlags& flags);

// Rays, and triangles at pixel centres, by flags that checkFlags() has taken.
//   samples  a pixel; else as many as usual
//   told     the share of the picture that is done; may be null
OpaquePlanes trace(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                   std::optional<int> samples, const ColourSpace& space, const std::function<void(double)>& told,
                   Stages& stages);
OpaquePlanes rasterise(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                       Stages& stages, std::string& device);

}  // namespace pellucid::cli
