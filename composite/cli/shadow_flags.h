// Flags of shadows, and the step they ask for: transparent things shadow the opaque picture before they go onto it.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "composite/cli/shot.h"
#include "engine_bridge/embree/shadow_rays.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid::cli {

struct ShadowFlags {
  std::string shadows = "off";
  std::vector<std::string> lights;
  bool apply = false;
  int size = 4096;
  std::string views;  // file, or ""
  void addTo(CLI::App& verb);
  bool on() const { return shadows != "off"; }
  bool exact() const { return shadows == "exact" || shadows == "exact:opaque"; }  // by rays
  bool mapped() const { return on() && !exact(); }
  int sizeFor(const Scene& scene) const;  // --shadow-size, or what the scene's casters want
  void check() const;  // throws UsageError for flags that mean nothing without --shadows, or are not NAME=LAYER

 private:
  CLI::Option* sizeOption_ = nullptr;
};

struct ShadowResult {
  Image<std::uint8_t> touched;             // opaque pixels that changed; empty with --shadows off
  std::vector<ExtraLayer> layers;          // `shadow`, where no layer of a light was there to dim
  std::shared_ptr<const ShadowMaps> maps;  // null unless shadows are by maps
  std::shared_ptr<const ShadowRays> rays;  // null unless they are exact
};

// Dims the beauty of `shot`. Says on stderr what it could not know. Throws MeaningError for a light or layer that is
// not there.
//   samples  positions in a pixel
//   seed     of the maps' coins
//   device   makes the GL context that maps are drawn with
ShadowResult castShadows(const ShadowFlags& flags, Shot& shot, int samples, std::uint32_t seed,
                         const std::function<GlContext&()>& device);

// What rays say of the light on the shot's transparent surfaces, past surfaces and particles. Null unless shadows are
// exact and some such surface is lit. The arguments must outlive it.
std::shared_ptr<const SurfaceVisibility> surfaceLight(const ShadowResult& shadows, const Shot& shot);

}  // namespace pellucid::cli
