// Flags that say which linear space colours are in.
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct ColourFlags {
  std::string config, workingSpace = "auto";
  std::string assetRoot;  // of addConfigTo()
  //   help  of --working-space
  void addTo(CLI::App& verb, const std::string& help);
  // --ocio alone, for what is only shown, and the folder whose files it may name besides.
  //   of  what is shown: "--preview"
  void addConfigTo(CLI::App& verb, const std::string& of = "--preview");
  // The config is that of --ocio, else of $OCIO.
  ColourRequest request() const;
};

// Puts the space and what says it into a report.
void reportSpace(const ColourSpace& space, nlohmann::json& report);

}  // namespace pellucid::cli
