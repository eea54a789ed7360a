// Flags that say what the opaque picture's channels mean.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/opaque_io.h"

namespace pellucid::cli {

struct ReadFlags {
  std::string preset = "auto", beauty, view, depth, depthKind;
  std::vector<std::string> aovs;
  std::optional<double> farValue, unit;
  //   allViews  whether --view takes all of them
  void addTo(CLI::App& verb, bool allViews = false);
  ReadOptions options() const;  // throws UsageError
};

}  // namespace pellucid::cli
