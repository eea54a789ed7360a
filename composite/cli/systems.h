// One transparent pass per coarsely sorted system: WB13 section 3.4. A system is an input file or a named node.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "composite/cli/render.h"

namespace pellucid::cli {

// A part of the scene, drawn by a pass of its own.
struct SystemPass {
  std::string name;  // of the file or node
  double z = 0;      // planar metres to the middle of its bounding box
  Scene scene;
  std::unique_ptr<TransparentPass> pass;
};

// Splits the shot's transparent geometry, farthest first. Geometry and textures are copied.
//   rule  "file" or "node"
std::vector<SystemPass> splitSystems(const std::string& rule, const std::vector<std::string>& paths, const Shot& shot,
                                     GlContext& context);

// One sample: every system by its own lists and method, the nearer veils over the farther ones. What layers show of the
// background, and solids, are those of the whole scene.
//   whole  the pass of all systems together
Veil veilFromSystems(TransparentPass& whole, std::vector<SystemPass>& systems, const RenderSettings& settings,
                     const PassSettings& sample, const GBuffer& gbuffer, RenderCounts& counts);

}  // namespace pellucid::cli
