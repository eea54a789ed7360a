// What a run hands back.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "composite/error.h"
#include "composite/pipeline/journal.h"
#include "composite/pipeline/plan.h"
#include "composite/resolve.h"
#include "composite/tolerance.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

struct RunCounts {
  std::size_t triangles = 0, chunks = 0, tiles = 0, fragments = 0;
  ToleranceCounts tolerance = {};
  int bitsPerPixel = 0, solidBits = 0, passes = 0;
  PublishedClamps clamps = {};
  std::size_t shadowRays = 0;  // of all passes
  double shadowSeconds = 0;
  std::vector<std::string> pruned = {};

  void add(const PassStatistics& statistics);  // what one pass did
  void add(const RunCounts& view);             // what another view of the same picture took
};

// What --method auto found.
struct Choice {
  double tolerance = 0.0;          // E
  double layers = 0.0;             // a pixel of the picture, on the probes
  double onProbes = 0.0;           // largest error of the sums there, as a part of what E promises
  std::optional<double> measured;  // the same on every pixel, where the sums were drawn
};

struct Result {
  Plan plan;          // as it was carried out: with the weight that was fitted
  Window dataWindow;  // of the picture
  Veil veil;          // of the part where layers may be; of all of the window where layers of it were asked for
  Picture picture;    // touched: changed by layers or by shadows
  std::vector<ExtraLayer> layers;        // `shadow`, and those that were asked for
  std::optional<ErrorStatistics> error;  // against the sorted truth, when it was asked for
  std::optional<Choice> choice;          // of --method auto
  RunCounts counts;
  Stages stages;
  std::string device = "CPU";
};

}  // namespace pellucid
