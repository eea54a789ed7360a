// A method of composite/methods/, pixel by pixel.
#include "composite/pipeline/painters/lists_painter.h"

namespace pellucid {
namespace {

class ListedMixer : public Mixer {
 public:
  explicit ListedMixer(const ChosenMethod& method) : method_(method) {}
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    compositeBy(method_, {0, mixed.sample.weight, mixed.sample.normalisation}, lists, mixed.data, veil);
  }
  void mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override { mix(mixed, lists, veil); }

 private:
  ChosenMethod method_;
};

}  // namespace

std::unique_ptr<Mixer> methodMixer(const ChosenMethod& method) {
  return std::make_unique<ListedMixer>(method);
}

std::unique_ptr<Painter> listedPainter(const PaintContext& context) {
  return listsPainter(context, methodMixer(context.plan.as<PaintListed>()->method));
}

}  // namespace pellucid
