// The flags that say when a shot is taken.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "composite/pipeline/shot_time.h"

namespace pellucid::cli {

struct TimeFlags {
  std::optional<int> frame;
  std::optional<double> seconds, framesPerSecond, offset;
  std::vector<std::string> animations;
  void addTo(CLI::App& verb);
  ShotTime time() const;
};

}  // namespace pellucid::cli
