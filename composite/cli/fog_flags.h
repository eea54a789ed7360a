// Flags of fog, and the medium that they describe, ready for one shot.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "composite/cli/particle_flags.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::cli {

// What --fog says: a list key=value,... or a JSON file of one object with the same keys.
struct FogText {
  MediumSettings medium;
  int shafts = 96;   // texels along the longest edge of the light volume; 0: nothing stands before the lights
  bool zUp = false;  // the grid's
};
// Throws UsageError, or InputError for a file that cannot be read.
FogText readFog(const std::string& text);

struct FogFlags {
  std::string fog, grid;
  void addTo(CLI::App& verb);
  bool on() const { return !fog.empty() || !grid.empty(); }
  // Null when off. Throws UsageError, MeaningError (nothing to place it by), and what readDensityGrid throws.
  //   why  what cannot have fog, "" when all can
  std::shared_ptr<const Fog> place(const Shot& shot, Air& air, double metresPerUnit, const std::string& why,
                                   Stages& stages) const;
};

}  // namespace pellucid::cli
