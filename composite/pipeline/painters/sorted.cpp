// Sorted compositing in double precision: the truth.
#include "composite/over.h"
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {
namespace {

class SortedMixer : public Mixer {
 public:
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    compositeSorted(lists, mixed.data, veil);
  }
  VolumeRule rule() const override { return VolumeRule::split; }
  bool exactScatter() const override { return true; }
  bool cutsTexels() const override { return true; }
  bool takesLean() const override { return true; }
};

}  // namespace

std::unique_ptr<Painter> sortedPainter(const PaintContext& context) {
  return listsPainter(context, std::make_unique<SortedMixer>());
}

}  // namespace pellucid
