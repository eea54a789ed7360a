// The command line's flags, as the rooms understand them. Each verb adds the groups it honours, and no other.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "composite/methods/method.h"
#include "engine_bridge/gl/transparent_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::cli {

struct ReadFlags {
  std::string preset = "auto", beauty, depth, depthKind = "planar";
  std::optional<double> farValue;
  double unit = 1.0;
  void addTo(CLI::App& verb);
  ReadOptions options() const;
};

struct SceneFlags {
  std::string camera, environment;
  std::vector<std::string> overrides;
  double lumensPerWatt = 683.0;
  std::string textureFilter = "mipmap", mask = "smooth", order = "file", budget = "256M";
  int device = -1;
  void addTo(CLI::App& verb);
  // For the transparent pass: triangles stay in their files, unless rays meet them too. Throws UsageError.
  SceneOptions options(double metresPerUnit, bool traced) const;
  void applyTo(PassSettings& settings) const;  // throws UsageError

 private:
  std::size_t pageBytes() const;  // of --budget, for pages of the files
};

struct MethodFlags {
  std::string method = "phenomenological", precision = "float", normalisation = "spectral", weight = "eq5", weightRange;
  bool autoAllowed = false;
  void addTo(CLI::App& verb, bool listsToo);
  void addWeightTo(CLI::App& verb, bool takesAuto);  // --normalisation, --weight, --weight-range alone
  bool isAuto() const { return weight == "auto"; }   // then the weight is to be fitted, see fitShotWeight
  bool isOver() const { return method == "over"; }
  bool isExact() const { return precision == "exact"; }
  bool isPublished() const { return precision == "published"; }
  // A method of the table that works from fragment lists. Throws UsageError for a flag that it cannot honour.
  std::optional<ChosenMethod> listMethod() const;
  const CLI::Option *weightOption = nullptr, *normalisationOption = nullptr;
  // The range comes from the flag, else from the camera, else 0.1:1000. Throws UsageError.
  void applyTo(PassSettings& settings, const Camera& camera) const;
};

struct RunFlags {
  int threads = 0;
  bool stats = false, json = false;
  void addTo(CLI::App& verb);
};

std::size_t parseBytes(const std::string& text, const std::string& flag);                // "64M", "2G", "1048576"
bool isColour(const std::string& text);                                                  // rather than a file
glm::vec3 parseColour(const std::string& text, const std::string& flag);                 // "R,G,B"
std::pair<double, double> parseRange(const std::string& text, const std::string& flag);  // "NEAR:FAR"

}  // namespace pellucid::cli
