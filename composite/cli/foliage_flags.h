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
  void addTo(CLI::App& verb);
  // Gives the settings occluders when the scene has leaves that want some: surroundings and masks must be settled.
  //   pass  null when nothing is shaded
  void applyTo(PassSettings& settings, TransparentPass* pass, const GBuffer& gbuffer, const Camera& camera,
               Stages& stages) const;
};

}  // namespace pellucid::cli
