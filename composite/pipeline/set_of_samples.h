// The samples of one pass as the device draws them, set after set where they are to be adaptive.
#pragma once
#include "composite/methods/stochastic.h"
#include "engine_bridge/gl/stochastic_pass.h"

namespace pellucid {

//   pass, passes  this one's number, and how many share a pixel's samples
//   statistics    added to
StochasticPlanes drawSamples(StochasticPass& sampler, const PassSettings& sample, const StochasticSettings& settings,
                             int pass, int passes, PassStatistics& statistics);

}  // namespace pellucid
