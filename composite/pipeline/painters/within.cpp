// The weighted sum where its error is proved to be within the tolerance, sorted compositing elsewhere.
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {
namespace {

std::size_t accountsOf(const PaintContext& context) {
  if (context.plan.heldOut) return placesOf(*context.picture.deepOpaque);
  return context.picture.gbuffer->viewZ.size();
}

class WithinMixer : public Mixer {
 public:
  WithinMixer(const PaintContext& context, double tolerance)
      : picture_(context.picture),
        counts_(context.counts.tolerance),
        promised_(accountsOf(context), tolerance, context.plan.passes) {}
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    const MethodChoice choice{0, mixed.sample.weight, mixed.sample.normalisation};
    compositeWithin({lists, choice, mixed.data, mixed.background, mixed.scatter, picture_.passWeight,
                     mixed.row ? &mixed.row->place : nullptr},
                    promised_, veil, counts_);
  }
  bool settled() override {
    const bool holds = promised_.settle();
    if (!holds) counts_ = {};
    counts_.bound = promised_.largestBound();
    return holds;
  }
  VolumeRule rule() const override { return VolumeRule::split; }
  bool cutsTexels() const override { return true; }
  bool exactScatter() const override { return true; }  // lookups are those of the truth, to the bit

 private:
  const LitPicture& picture_;  // of the pass that is mixed
  ToleranceCounts& counts_;
  PromisedError promised_;  // of all passes
};

}  // namespace

std::unique_ptr<Painter> withinPainter(const PaintContext& context) {
  return listsPainter(context, std::make_unique<WithinMixer>(context, context.plan.as<PaintWithin>()->tolerance));
}

}  // namespace pellucid
