// The weighted sum where its error is proved to be within the tolerance, sorted compositing elsewhere.
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {
namespace {

class WithinMixer : public Mixer {
 public:
  WithinMixer(const PaintContext& context, double tolerance) : counts_(context.counts), tolerance_(tolerance) {}
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    compositeWithin(lists, {0, mixed.sample.weight, mixed.sample.normalisation}, mixed.data, mixed.background,
                    mixed.scatter, tolerance_, veil, counts_.tolerance);
  }
  VolumeRule rule() const override { return VolumeRule::split; }

 private:
  RunCounts& counts_;
  double tolerance_;
};

}  // namespace

std::unique_ptr<Painter> withinPainter(const PaintContext& context) {
  return listsPainter(context, std::make_unique<WithinMixer>(context, context.plan.as<PaintWithin>()->tolerance));
}

}  // namespace pellucid
