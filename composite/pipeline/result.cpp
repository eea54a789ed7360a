#include "composite/pipeline/result.h"

namespace pellucid {

void RunCounts::add(const PassStatistics& statistics) {
  triangles = statistics.triangles;
  chunks += statistics.chunks;
  tiles += statistics.tiles;
  fragments += statistics.fragments;
  bitsPerPixel = statistics.bitsPerPixel;
  solidBits = statistics.solidBits;
  passes = statistics.passes;
  pruned = statistics.pruned;
  clamps += statistics.clamps;
  shadowRays += statistics.shadowRays;
  shadowSeconds += statistics.shadowSeconds;
}

void RunCounts::add(const RunCounts& view) {
  chunks += view.chunks;
  tiles += view.tiles;
  fragments += view.fragments;
  tolerance.certified += view.tolerance.certified;
  tolerance.recomputed += view.tolerance.recomputed;
  clamps += view.clamps;
  shadowRays += view.shadowRays;
  shadowSeconds += view.shadowSeconds;
}

}  // namespace pellucid
