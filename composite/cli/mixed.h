// Sums of a shot whose marked materials are drawn at low resolution.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/cli/messages.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::cli {

// --low-res: pixels per texel, in both axes, of materials marked lowResolution. What they are drawn at when nobody
// says.
constexpr int kLowResolution = 4;

struct LowResFlags {
  int factor = kLowResolution;
  const CLI::Option* option = nullptr;
  void addTo(CLI::App& verb);
  // 1 where the shot marks no material, or where its sums must come from lists of full resolution: then the marks are
  // passed over, which is said, unless the flag asked for them.
  //   why  what cannot draw at low resolution, "" when all can
  // Throws UsageError for a flag that cannot be honoured.
  int factorFor(const Scene& scene, const std::string& why) const;
};

// As TransparentPass::accumulate(); factor 1 draws everything at full resolution.
OitPlanes accumulateMixed(TransparentPass& pass, const PassSettings& settings, const GBuffer& gbuffer,
                          const Camera& camera, int factor, PassStatistics& statistics);

}  // namespace pellucid::cli
