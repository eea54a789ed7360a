// A shot through a method to a veil: N jittered passes, each resolved, averaged in fixed order.
#pragma once
#include "composite/cli/device_resolve.h"
#include "composite/cli/messages.h"
#include "composite/cli/mixed.h"
#include "composite/cli/shot.h"
#include "composite/methods/stochastic.h"
#include "composite/resolve.h"
#include "composite/tolerance.h"
#include "engine_bridge/gl/stochastic_pass.h"

namespace pellucid::cli {

struct SystemPass;

struct RenderSettings {
  PassSettings pass;
  ResolveSettings resolve;
  LookupSettings lookup;
  bool exactSums = false;                        // --precision exact
  bool sortedTruth = false;                      // `over`
  int samples = 1;                               // --aa
  ResolvePass* device = nullptr;                 // --resolve gl; null: the CPU resolves
  int lowResolution = 1;                         // --low-res, of sums without lists
  std::optional<ChosenMethod> listMethod;        // a method that works from fragment lists; nothing: the GL pass's sums
  const DeepOpaque* deepOpaque = nullptr;        // the picture, when it is deep
  std::vector<SystemPass>* systems = nullptr;    // each its own pass, farthest first
  std::optional<StochasticSettings> stochastic;  // from lists too; its samples are spread over all the passes
  StochasticPass* sampler = nullptr;             // --sampled-on gl; null: the CPU samples lists
  std::optional<double> tolerance;               // certify the sums, composite exactly what they cannot
};

struct RenderCounts {
  std::size_t triangles = 0, chunks = 0, tiles = 0, fragments = 0;
  ToleranceCounts tolerance = {};
  int bitsPerPixel = 0, solidBits = 0, passes = 0;
  PublishedClamps clamps = {};
  std::size_t shadowRays = 0;  // of all passes
  double shadowSeconds = 0;
  std::vector<std::string> pruned = {};
};

// Asks for a method of the table; nothing asks for none of them. `weighted` and `blended` are the transparent pass's
// own sums: they need no lists. After the flags have set the pass's weight.
void useMethod(const std::optional<ChosenMethod>& chosen, RenderSettings& settings);

// Adds what one pass did.
void addStatistics(const PassStatistics& statistics, RenderCounts& counts);

//   pass  null when the shot has no geometry
//   deep  the shot's deep files, whose samples join the pass's fragments
Veil renderVeil(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const RenderSettings& settings,
                const GBuffer& gbuffer, const Camera& camera, Stages& stages, RenderCounts& counts);

// Fits the weight to the sorted truth on probe pixels at their centres, and says what was chosen. --weight auto
void fitShotWeight(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const GBuffer& gbuffer,
                   PassSettings& settings, Stages& stages);

}  // namespace pellucid::cli
