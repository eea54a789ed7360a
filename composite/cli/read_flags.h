// Flags that say what the opaque picture's channels mean.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "gbuffer/opaque_io.h"

namespace pellucid::cli {

struct ReadFlags {
  std::string preset = "auto", beauty, view, depth, depthKind;
  std::optional<double> farValue, unit;
  void addTo(CLI::App& verb);
  ReadOptions options() const;
};

}  // namespace pellucid::cli
