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

}  // namespace pellucid
