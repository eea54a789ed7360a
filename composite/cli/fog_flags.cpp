#include "composite/cli/fog_flags.h"

#include "composite/pipeline/fog_text.h"

namespace pellucid::cli {

void FogFlags::addTo(CLI::App& verb) {
  verb.add_option("--fog", fog, std::string("Fog before the picture: key=value,... or FILE.json; keys: ") + kFogKeys);
  verb.add_option("--fog-grid", grids,
                  "FILE.vdb[:GRID][=density|emission|temperature]: a grid of OpenVDB; may be repeated. Densities "
                  "(`density` by default) add up and are multiplied by --fog density=D (1); emission is the radiance "
                  "that a metre adds, times --fog emission=E (1); temperature glows as a black body. Without a role, "
                  "`temperature`, `emission` and `flames` are what they are called, all others density")
      ->allow_extra_args(false);
}

void FogFlags::into(Request& request) const {
  FogRequest& asked = request.fog;
  if (fog.ends_with(".json"))
    asked.file = fog;
  else if (!fog.empty())
    asked.text = readFogText(fog);
  for (const std::string& grid : grids) asked.grids.push_back(readFogGrid(grid));
}

}  // namespace pellucid::cli
