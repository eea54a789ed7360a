// A shot through a method to a veil: N jittered passes, each resolved, averaged in fixed order.
#pragma once
#include "composite/cli/messages.h"
#include "composite/cli/shot.h"
#include "composite/resolve.h"

namespace pellucid::cli {

struct RenderSettings {
  PassSettings pass;
  ResolveSettings resolve;
  bool sortedTruth = false;  // `over`
  int samples = 1;           // --aa
};

struct RenderCounts {
  std::size_t triangles = 0, chunks = 0, tiles = 0, fragments = 0;
};

Veil renderVeil(TransparentPass& pass, const RenderSettings& settings, const GBuffer& gbuffer, Stages& stages,
                RenderCounts& counts);

}  // namespace pellucid::cli
