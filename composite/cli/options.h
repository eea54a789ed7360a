// The command line's flags, as the rooms understand them. Each verb adds the groups it honours, and no other.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/colour_flags.h"
#include "composite/cli/read_flags.h"
#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct SceneFlags {
  std::vector<std::string> cameras;  // one, or VIEW=one for each view
  std::string environment, assetRoot;
  std::vector<std::string> overrides;
  double lumensPerWatt = 683.0, unit = 1.0;  // metres in one unit of the glTF
  std::string textureFilter = "mipmap", mask = "smooth", order = "file", budget = "256M";
  int device = -1;
  ColourFlags colour;
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError
};

// The camera of a view, by its own entry or by the one for all. Throws UsageError for two, and for an entry of a view
// that is none of `views`.
CameraChoice cameraOfView(const std::vector<std::string>& cameras, const std::string& view,
                          const std::vector<std::string>& views);
CameraChoice cameraChoice(const std::string& text);              // "", a name or eye=...;look=...; throws UsageError
SurroundingsChoice surroundingsChoice(const std::string& text);  // "", R,G,B or a file; throws UsageError

struct RunFlags {
  int threads = 0;
  bool stats = false, json = false;
  void addTo(CLI::App& verb);
};

std::size_t parseBytes(const std::string& text, const std::string& flag);                // "64M", "2G", "1048576"
bool isColour(const std::string& text);                                                  // rather than a file
glm::vec3 parseColour(const std::string& text, const std::string& flag);                 // "R,G,B"
std::pair<double, double> parseRange(const std::string& text, const std::string& flag);  // "NEAR:FAR"

}  // namespace pellucid::cli
