// Flags of fog.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct FogFlags {
  std::string fog;
  std::vector<std::string> grids;
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError
};

}  // namespace pellucid::cli
