// The compositing step alone: files of sums over an opaque picture.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "composite/pipeline/device.h"
#include "composite/pipeline/request.h"
#include "composite/pipeline/result.h"

namespace pellucid {

// Of rims that the planes carry apart.
struct RimRequest {
  std::optional<bool> infer;     // false leaves them open
  std::optional<int> form;       // PLD_OCCLUSION_*
  std::optional<bool> fromFile;  // the picture's AO channel where it has one
  std::optional<double> radius;  // metres
  bool any() const { return infer || form || fromFile || radius; }
};

struct PlanesRequest {
  std::string opaque;
  ReadOptions read;
  std::vector<std::string> planes;  // several are added
  std::optional<bool> selfModulation;
  LookupSettings lookup;
  bool onDevice = false;
  RimRequest rims;
  std::vector<LayerName> layers;
};

struct ResolvedPlanes {
  OpaqueFile opaque;
  Camera camera;  // of the planes
  OitInfo info;   // of the planes
  Veil veil;
  Picture picture;
  std::vector<ExtraLayer> layers;
  std::string device = "CPU";
};

// Throws UsageError before any file is opened.
void validate(const PlanesRequest& request);
// Throws what the readers throw, MeaningError for planes of another picture, and UsageError for what these planes
// cannot honour.
ResolvedPlanes resolvePlanes(const PlanesRequest& request, Journal& journal);

}  // namespace pellucid
