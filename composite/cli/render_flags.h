// The flags of every verb that renders, as one request.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/cli/blur_flags.h"
#include "composite/cli/fog_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/layer_flag.h"
#include "composite/cli/method_flags.h"
#include "composite/cli/options.h"
#include "composite/cli/scatter_flags.h"
#include "composite/cli/shadow_flags.h"
#include "composite/cli/stochastic_flags.h"
#include "composite/cli/time_flags.h"

namespace pellucid::cli {

// What a verb does with the layers, and so which flags it has.
struct RenderVerb {
  bool weighs = true;     // --method, --weight and what else decides between methods
  bool listsToo = true;   // methods that have no sums
  bool precision = true;  // one tier
  bool passes = true;     // --aa with one number
  bool edges = true;      // --edges and --filter
  bool blurs = false;     // --shutter and the lens
  bool bends = true;      // --refract and --diffusion
  bool resolves = true;   // lookups, --resolve, --self-modulation and --layers
  bool keepsRimsApart = false;
  bool allViews = false;  // --view all
  int defaultPasses = 1;
  UsualMethod usual = UsualMethod::truth;
};

struct RenderFlags {
  std::string opaque, systems = "off", edges = "resolve", filter;
  std::vector<std::string> inputs, layers, systemWeights;
  ReadFlags read;
  SceneFlags scene;
  TimeFlags time;
  BlurFlags blur;
  MethodFlags method;
  ScatterFlags scatter;
  LookupFlags lookup;
  FoliageFlags foliage;
  ShadowFlags shadow;
  FogFlags fog;
  StochasticFlags stochastic;
  SelfModulationFlag selfModulation;
  int supersampled = 1;  // N, where the verb has --supersampled
  int passes = 1, particleLight = 64, lowResolution = LowResolutionRequest::kDefault;
  std::optional<double> tolerance;
  bool measure = false;

  void addTo(CLI::App& verb, const RenderVerb& what);
  Request request() const;  // throws UsageError
  // The same of one view of several, with its own camera.
  Request requestOfView(const std::string& view, const std::vector<std::string>& views) const;

 private:
  void paintInto(Request& request) const;
  const CLI::Option *lowResolutionOption_ = nullptr, *edgesOption_ = nullptr, *passesOption_ = nullptr;
  bool ofOneMethod_ = true;  // which all flags of methods are read by
};

}  // namespace pellucid::cli
