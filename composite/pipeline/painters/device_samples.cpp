// Stochastic transparency whose samples the device draws. What they show of the background is looked up by the sums'
// scattering planes: the pixel's scattering layers alone decide, under every method.
#include <optional>

#include "composite/pipeline/painter.h"
#include "composite/pipeline/set_of_samples.h"

namespace pellucid {
namespace {

class DeviceSamplesPainter : public Painter {
 public:
  explicit DeviceSamplesPainter(const PaintContext& context)
      : context_(context),
        settings_(context.plan.as<PaintSamples>()->settings),
        sampler_(context.device.context(context.journal), context.shot.scene, *context.picture.gbuffer,
                 context.shot.camera),
        mean_(context.picture.gbuffer->data.width(), context.picture.gbuffer->data.height(), settings_,
              context.plan.passes) {}

  Veil paint(const PassSettings& sample, int pass) override {
    return context_.journal.time("sample", [&] { return sampled(sample, pass); });
  }
  void finish(Veil& mean) override { mean_.finish(mean); }

 private:
  Veil sampled(const PassSettings& sample, int pass) {
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    Veil veil(gbuffer.data.width(), gbuffer.data.height());
    PassStatistics statistics;
    if (context_.plan.layersMove()) sampler_.pose(context_.shot.camera);
    sampler_.over(gbuffer, context_.shot.camera);
    StochasticPlanes planes = drawSamples(sampler_, sample, settings_, pass, context_.plan.passes, statistics);
    TransparentPass& sums = *context_.sources.triangles();
    if (!sums.scatters(sample)) {
      mean_.add(planes, veil, context_.picture.passWeight);
    } else {
      PassSettings unlit = sample;  // of these sums only where they bend and spread is read
      unlit.shadows = nullptr;
      unlit.shadowRays = nullptr;
      unlit.occlusion.occluders = nullptr;
      OitPlanes scattering = sums.accumulate(unlit);
      const Backdrop backdrop = backdropOf(*context_.picture.centres, planes.solid);
      scattering.solid = planes.solid;
      hideSolids(scattering);
      planes.solid = scattering.solid;
      mean_.add(planes, veil, context_.picture.passWeight);
      showThrough(Lookups(backdrop, scattering, context_.plan.lookup, glm::ivec2(0), context_.picture.edges), veil);
    }
    statistics.bitsPerPixel = stochasticBits(settings_);
    context_.counts.add(statistics);
    return veil;
  }

  PaintContext context_;
  StochasticSettings settings_;
  StochasticPass sampler_;
  StochasticMean mean_;
};

}  // namespace

std::unique_ptr<Painter> deviceSamplesPainter(const PaintContext& context) {
  return std::make_unique<DeviceSamplesPainter>(context);
}

}  // namespace pellucid
