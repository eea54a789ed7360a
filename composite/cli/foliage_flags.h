// Flags of ambient occlusion at cut-out leaves, for the verbs that shade them.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/cli/messages.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::cli {

struct FoliageFlags {
  std::string occlusion = "inferred", inference = "relative", source = "auto";
  double direct = 0.0, radius = 0.0;
  CLI::Option* details[4] = {};  // that --occlusion off has no use for
  //   keepsApart  the verb can also leave the rims to `resolve`
  void addTo(CLI::App& verb, bool keepsApart = false);
  bool isApart() const { return occlusion == "apart"; }
  // Gives the settings occluders when the scene has leaves that want some: surroundings and masks must be settled.
  //   pass  null when nothing is shaded
  void applyTo(PassSettings& settings, TransparentPass* pass, const GBuffer& gbuffer, const Camera& camera,
               Stages& stages) const;
};

// The same of `resolve`, for planes that carry the light of their rims apart.
struct RimFlags {
  std::string occlusion = "inferred", inference = "relative", source = "auto";
  double radius = 0.0;
  std::vector<CLI::Option*> given;
  void addTo(CLI::App& verb);
  // Darkens the sums. Throws UsageError for a flag that planes without rims cannot honour.
  void applyTo(const RimPlanes& rims, const GBuffer& gbuffer, OitPlanes& planes) const;
};

}  // namespace pellucid::cli
