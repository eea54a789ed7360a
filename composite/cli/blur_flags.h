// The flags of motion blur and depth of field.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct BlurFlags {
  std::string shutter, focus, cameraMotion = "on";
  std::optional<double> lensRadius, fStop, focalLength;
  int blades = 0;
  void addTo(CLI::App& verb);
  std::optional<Shutter> shutterAsked() const;  // throws UsageError
  LensRequest lens() const;                     // throws UsageError
};

}  // namespace pellucid::cli
