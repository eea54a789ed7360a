// Flags of fog.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct FogFlags {
  std::string fog, grid;
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError
};

}  // namespace pellucid::cli
