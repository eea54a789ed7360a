// Flags of a PNG beside the picture, as a display shows it.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/colour/display.h"
#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct PreviewFlags {
  std::string file, display, viewTransform, look;
  double exposure = 0.0;
  void addTo(CLI::App& verb);
  bool wanted() const { return !file.empty(); }
  // What can be refused before any work. Throws UsageError, and what ColourConfig::read throws.
  //   forIt      the config serves the preview alone
  //   assetRoot  a folder whose files the config may name besides those under its own
  void check(const ColourRequest& colour, const std::string& assetRoot, bool forIt = false) const;
  // Writes it, where it is wanted.
  //   picture  as composited, in its own space; over black where it is not opaque
  void write(const ColourRequest& colour, const std::string& assetRoot, const ColourSpace& space,
             const Image<glm::vec4>& picture) const;

 private:
  DisplayChoice choice() const { return {display, viewTransform, exposure, look}; }
  const CLI::Option* exposureOption_ = nullptr;
};

}  // namespace pellucid::cli
