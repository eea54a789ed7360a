// Flags of refraction and diffusion.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

// Of the lookup alone: what the compositing step needs.
struct LookupFlags {
  std::string kernel = "gaussian", gather = "fast", resolver = "cpu";
  void addTo(CLI::App& verb);
  void addResolverTo(CLI::App& verb);
  void into(Request& request) const;
  LookupSettings settings() const;
  bool onDevice() const { return resolver == "gl"; }
};

// PT17 eq. 14. On with the published tier, off elsewhere, unless the user says.
struct SelfModulationFlag {
  void addTo(CLI::App& verb);
  // Empty unless the user says: then the tier decides.
  std::optional<bool> value() const { return option && option->count() > 0 ? std::optional(asked) : std::nullopt; }
  bool asked = false;
  const CLI::Option* option = nullptr;
};

// Of the transparent pass.
struct ScatterFlags {
  std::string refract = "depth", diffusion = "coverage", diffusionScale = "0.3:0.5", dispersion = "on";
  bool noPrune = false;
  void addTo(CLI::App& verb);
  void into(Request& request) const;  // throws UsageError
};

}  // namespace pellucid::cli
