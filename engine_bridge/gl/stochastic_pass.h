// Stochastic transparency on the device: two passes over the geometry, in any order, of any number of samples. ST10
// section 3; what composite/methods/stochastic.h does from fragment lists.
#pragma once
#include <memory>

#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/mask_table.h"
#include "gbuffer/stochastic_planes.h"

namespace pellucid {

struct StochasticPassSettings {
  int samples = 64;          // S of a pixel, in all passes together
  int first = 0, step = 1;   // this pass holds samples first, first + step, ...
  bool stratified = true;    // masks; otherwise a coin per sample
  bool winnersOnly = false;  // a fragment counts by the samples that it won, else by those that see it
  std::uint32_t seed = 0;
};

struct StochasticPassStatistics {
  double coverSeconds = 0, addSeconds = 0;
  int passes = 0;  // over the geometry
  std::size_t bands = 0, fragments = 0;
  std::size_t shadowRays = 0;  // as PassStatistics
  double shadowSeconds = 0;
};

class StochasticPass {
 public:
  // The arguments must outlive this.
  StochasticPass(GlContext& context, const Scene& scene, const GBuffer& gbuffer, const Camera& camera);
  ~StochasticPass();

  // As TransparentPass has them.
  void pose(const Camera& camera);
  void over(const GBuffer& gbuffer, const Camera& camera);

  // Whether layers refract or diffuse under these settings, which this pass leaves out.
  bool scatters(const PassSettings& settings) const;

  // One pass. Samples are kept in a storage buffer, a depth each, whatever the device's multisampling; the picture is
  // drawn in bands that fit it. Sums are whole steps of a grid that each pixel chooses by its brightest fragment and
  // their number: the same bits for every submission order and chunking. Of the tier, weight, normalisation and scatter
  // settings nothing counts here. Throws ResourceError when the device has no room.
  StochasticPlanes sample(const PassSettings& settings, const StochasticPassSettings& samples);
  const StochasticPassStatistics& statistics() const;  // of the last pass

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
