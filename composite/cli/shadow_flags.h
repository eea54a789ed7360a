// Flags of shadows: transparent things shadow the opaque picture before they go onto it, and each other.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

struct ShadowFlags {
  std::string shadows = "off";
  std::vector<std::string> lights;
  bool apply = false;
  int size = 4096;
  std::string views;  // file, or ""
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError for what is not NAME=LAYER

 private:
  CLI::Option* sizeOption_ = nullptr;
};

}  // namespace pellucid::cli
