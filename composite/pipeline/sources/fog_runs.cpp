// Fog as layers: what lies between two surfaces that follow one another in depth is one run.
#include "composite/fog.h"
#include "composite/pipeline/layer_source.h"

namespace pellucid {
namespace {

class FogRuns : public LayerSource {
 public:
  const char* name() const override { return "fog"; }
  bool runsBetween() const override { return true; }
  ListSink into(const SourceView& view, ListSink next) override {
    if (!view.settings.fog) return next;
    return [&view, next = std::move(next)](const FragmentLists& lists) {
      const PassSettings& settings = view.settings;
      FragmentLists joined =
          withFog(*settings.fog, *view.picture.gbuffer, settings.sample, lists, view.picture.deepOpaque);
      next(settings.pieces ? tiedToPixels(lists, std::move(joined)) : joined);
    };
  }
};

}  // namespace

std::unique_ptr<LayerSource> fogRuns() {
  return std::make_unique<FogRuns>();
}

}  // namespace pellucid
