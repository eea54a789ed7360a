// The two renderers behind `gbuffer`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/colour_flags.h"
#include "composite/cli/options.h"
#include "composite/cli/preview_flags.h"
#include "composite/pipeline/journal.h"
#include "engine_bridge/scene/opaque_planes.h"
#include "engine_bridge/scene/scene.h"
#include "gbuffer/colour_space.h"

namespace pellucid::cli {

struct GbufferFlags {
  std::vector<std::string> scenes;
  std::string output, renderer = "embree", size, camera, environment, shadows, textureFilter, assetRoot, filter;
  std::optional<int> samples;
  std::optional<double> aoRadius;
  std::vector<std::string> overrides;
  double unit = 1.0, lumensPerWatt = 683.0;
  int device = -1;
  ColourFlags colour;
  PreviewFlags preview;
  RunFlags run;
};

Window parseSize(const std::string& text);  // "1920x1080"; throws UsageError

void checkFilter(const GbufferFlags& flags);  // that the renderer honours it; throws UsageError

// Rays, and triangles at pixel centres. Both throw UsageError for flags that the other alone honours.
OpaquePlanes trace(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                   const ColourSpace& space, Stages& stages);
OpaquePlanes rasterise(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                       Stages& stages, std::string& device);

}  // namespace pellucid::cli
