// Stochastic transparency from fragment lists.
#include <fmt/format.h>

#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {
namespace {

class SamplesMixer : public Mixer {
 public:
  SamplesMixer(const PaintContext& context, const StochasticSettings& settings)
      : settings_(settings),
        passes_(context.plan.passes),
        journal_(context.journal),
        picture_(context.picture),
        mean_(context.plan.heldOut
                  ? std::make_unique<StochasticMean>(*context.picture.deepOpaque, settings, context.plan.passes)
                  : std::make_unique<StochasticMean>(context.picture.gbuffer->data.width(),
                                                     context.picture.gbuffer->data.height(), settings,
                                                     context.plan.passes)) {}
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    if (mixed.row)
      mean_->add(mixed.pass, *mixed.row, veil);
    else
      mean_->add(mixed.pass, lists, mixed.data, veil, picture_.passWeight);
  }
  bool cutsTexels() const override { return true; }
  void finish(Veil& mean) override {
    mean_->finish(mean);
    if (settings_.adaptive <= 0.0 || mean_->pixelsSampled() == 0) return;
    journal_.note(fmt::format(
        "samples: {:.1f} a pixel on the average of those that hold a layer",
        static_cast<double>(mean_->samplesTaken()) * passes_ / static_cast<double>(mean_->pixelsSampled())));
  }

 private:
  StochasticSettings settings_;
  int passes_;
  Journal& journal_;
  const LitPicture& picture_;             // of the pass that is mixed
  std::unique_ptr<StochasticMean> mean_;  // of all passes: masks are stratified across them
};

}  // namespace

std::unique_ptr<Painter> samplesPainter(const PaintContext& context) {
  return listsPainter(context, std::make_unique<SamplesMixer>(context, context.plan.as<PaintSamples>()->settings));
}

}  // namespace pellucid
