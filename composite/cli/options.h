// The command line's flags, as the rooms understand them. Each verb adds the groups it honours, and no other.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "composite/cli/camera_flag.h"
#include "composite/cli/colour_flags.h"
#include "composite/cli/parse.h"
#include "composite/cli/read_flags.h"
#include "composite/pipeline/request.h"

namespace pellucid::cli {

// --thin auto|file, of every verb that draws glass.
void addThinFlag(CLI::App& verb, std::string& thin);

struct SceneFlags {
  std::vector<std::string> cameras;  // one, or VIEW=one for each view
  std::string environment, assetRoot, thin = "auto";
  std::vector<std::string> overrides;
  double lumensPerWatt = 683.0, unit = 1.0;  // metres in one unit of the glTF
  std::string textureFilter = "mipmap", mask = "smooth", order = "file", budget = "256M";
  int device = -1;
  ColourFlags colour;
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError
};

constexpr int kMostThreads = 1024;

struct RunFlags {
  int threads = 0;
  bool stats = false, json = false;
  void addTo(CLI::App& verb);
};

}  // namespace pellucid::cli
