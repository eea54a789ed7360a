#include "composite/cli/fog_flags.h"

#include "composite/pipeline/fog_step.h"

namespace pellucid::cli {

void FogFlags::addTo(CLI::App& verb) {
  verb.add_option("--fog", fog, std::string("Fog before the picture: key=value,... or FILE.json; keys: ") + kFogKeys);
  verb.add_option("--fog-grid", grid,
                  "FILE.vdb[:GRID]: an OpenVDB density grid (`density` by default), multiplied by --fog density=D (1)");
}

void FogFlags::into(Request& request) const {
  FogRequest& asked = request.fog;
  if (fog.ends_with(".json"))
    asked.file = fog;
  else if (!fog.empty())
    asked.text = readFogText(fog);
  asked.grid = grid;
  const auto colon = grid.rfind(".vdb:");
  if (colon == std::string::npos) return;
  asked.grid = grid.substr(0, colon + 4);
  asked.gridName = grid.substr(colon + 5);
}

}  // namespace pellucid::cli
