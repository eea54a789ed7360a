#include "composite/cli/colour_flags.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

namespace pellucid::cli {

void ColourFlags::addConfigTo(CLI::App& verb, const std::string& of) {
  verb.add_option("--ocio", config, "Of " + of + ": OpenColorIO config; without it that of $OCIO, else a built-in one");
  verb.add_option("--asset-root", assetRoot, "Folder whose files a config may name besides those under its own folder");
}

void ColourFlags::addTo(CLI::App& verb, const std::string& help) {
  verb.add_option("--ocio", config,
                  "OpenColorIO config with the spaces that --working-space names and rules for files; without it that "
                  "of $OCIO, else a built-in one");
  verb.add_option("--working-space", workingSpace, help + ": a name, role or alias of the config, or auto")
      ->capture_default_str();
}

ColourRequest ColourFlags::request() const {
  ColourRequest request;
  request.workingSpace = workingSpace;
  request.config = config;
  const char* variable = std::getenv("OCIO");
  if (config.empty() && variable && *variable) {
    request.config = variable;
    request.configBy = "$OCIO";
  }
  return request;
}

void reportSpace(const ColourSpace& space, nlohmann::json& report) {
  report["colourSpace"] = {{"name", space.name}, {"by", nameOf(space.source)}};
}

}  // namespace pellucid::cli
