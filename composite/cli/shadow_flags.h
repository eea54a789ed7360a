// Flags of shadows, and the step they ask for: transparent things shadow the opaque picture before they go onto it.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/cli/shot.h"

namespace pellucid::cli {

struct ShadowFlags {
  std::string shadows = "off";
  std::vector<std::string> lights;
  bool apply = false;
  void addTo(CLI::App& verb);
  bool on() const { return shadows != "off"; }
  void check() const;  // throws UsageError for flags that mean nothing without --shadows, or are not NAME=LAYER
};

struct ShadowResult {
  Image<std::uint8_t> touched;     // opaque pixels that changed; empty with --shadows off
  std::vector<ExtraLayer> layers;  // `shadow`, where no layer of a light was there to dim
};

// Dims the beauty of `shot`. Says on stderr what it could not know. Throws MeaningError for a light or layer that is
// not there.
//   samples  positions in a pixel
ShadowResult castShadows(const ShadowFlags& flags, Shot& shot, int samples);

}  // namespace pellucid::cli
