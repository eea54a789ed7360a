// Flags of refraction and diffusion, and the planes that show what they did.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/gather.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::cli {

// Of the lookup alone: what the compositing step needs.
struct LookupFlags {
  std::string kernel = "gaussian", gather = "fast", resolver = "cpu";
  bool onDevice() const { return resolver == "gl"; }
  void addTo(CLI::App& verb);
  void addResolverTo(CLI::App& verb);
  LookupSettings settings() const;  // throws UsageError
};

// PT17 eq. 14. On with the published tier, off elsewhere, unless the user says.
struct SelfModulationFlag {
  void addTo(CLI::App& verb);
  bool isOn(bool published) const { return option->count() > 0 ? asked : published; }
  bool asked = false;
  const CLI::Option* option = nullptr;
};

// Of the transparent pass.
struct ScatterFlags {
  std::string refract = "depth", diffusion = "coverage", diffusionScale = "0.3:0.5", dispersion = "on";
  bool noPrune = false;
  void addTo(CLI::App& verb);
  void applyTo(PassSettings& settings) const;  // throws UsageError
};

// Names of --layers that show planes of the transparent pass, at pixel centres.
const std::vector<std::string>& debugLayerNames();
bool wantsDebugLayers(const std::vector<std::string>& layers);
std::vector<ExtraLayer> debugLayers(const std::vector<std::string>& layers, const OitPlanes& planes);

}  // namespace pellucid::cli
