#include "composite/pipeline/painters/lists_painter.h"

#include <algorithm>
#include <optional>

#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/list_order.h"
#include "composite/over.h"
#include "composite/pipeline/low_layers.h"
#include "composite/pipeline/sums.h"

namespace pellucid {

void Mixer::mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil) {
  compositeSorted(lists, mixed.data, veil);
}
void Mixer::mixLean(const LeanLists& lists, const Window& data, Veil& veil) {
  compositeSorted(lists, data, veil);
}

namespace {

class ListsPainter : public Painter {
 public:
  ListsPainter(const PaintContext& context, std::unique_ptr<Mixer> mixer)
      : context_(context), mixer_(std::move(mixer)) {}

  Veil paint(const PassSettings& sample, int pass) override {
    return context_.journal.time(mixer_->takesLean() ? "lists and sort" : "lists and method",
                                 [&] { return painted(sample, pass); });
  }
  bool settled() override { return mixer_->settled(); }
  void finish(Veil& mean) override { mixer_->finish(mean); }

 private:
  Veil painted(const PassSettings& sample, int pass) {
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    const Plan& plan = context_.plan;
    Veil veil(gbuffer.data.width(), gbuffer.data.height());
    if (leanWillDo(sample)) {
      context_.sources.triangles()->leanFragments(
          sample, [&](const LeanLists& lists) { mixer_->mixLean(lists, gbuffer.data, veil); });
      context_.counts.add(context_.sources.triangles()->statistics());
      return veil;
    }
    if (plan.heldOut) {
      veil.addScatter();
      lookedUp_ = Image<glm::vec3>(gbuffer.data.width(), gbuffer.data.height(), glm::vec3(0.0f));
    }
    low_.reset();
    PassStatistics lowStatistics;
    if (plan.lowResolution > 1) low_.emplace(lowLayersOf(context_, sample, pass, *mixer_, lowStatistics));
    scatters_ = context_.sources.mayScatter(fullResolutionPart(plan, sample)) || (low_ && low_->scatters());
    planes_ = scatters_ ? emptyPlanes(gbuffer.display, gbuffer.data) : OitPlanes();
    list(sample, pass, veil);
    if (TransparentPass* triangles = context_.sources.triangles()) {
      PassStatistics statistics = triangles->statistics();
      statistics.fragments += lowStatistics.fragments;
      statistics.passes += lowStatistics.passes;
      context_.counts.add(statistics);
    }
    mixer_->endPass(planes_);
    if (planes_.scatters()) showBackground(veil);
    return veil;
  }

  void list(const PassSettings& sample, int pass, Veil& veil) {
    PassSettings listed = fullResolutionPart(context_.plan, sample);
    if (fogBeside()) listed.fog = nullptr;
    const SourceView view{listed, context_.picture, mixer_->rule()};
    const ListSink mixes = [&](const FragmentLists& lists) {
      if (!context_.sources.triangles()) context_.counts.fragments += lists.fragments.size();
      window(sample, pass, low_ ? low_->among(lists) : lists, veil);
    };
    context_.sources.each(view, mixes);
  }

  // Mixers that read depths and colours alone, where nothing but triangles is there.
  bool leanWillDo(const PassSettings& sample) const {
    return mixer_->takesLean() && !context_.plan.heldOut && context_.sources.trianglesAlone() &&
           context_.plan.lowResolution == 1 && !context_.sources.mayScatter(sample);
  }

  bool fogBeside() const { return context_.plan.heldOut && mixer_->fogBeside(); }

  void window(const PassSettings& sample, int pass, const FragmentLists& given, Veil& veil) {
    // Every method shows the same background, which the pixel's scattering layers alone decide.
    if (scatters_ && (mixer_->exactScatter() || context_.plan.isExact()))
      foldExact(given, sample.weight, sample.normalisation, planes_);
    else if (scatters_)
      foldScattering(given, planes_);
    if (!scatters_ && !context_.plan.isExact()) {
      mix(sample, pass, given, veil);
      return;
    }
    FragmentLists shown = given;
    if (scatters_) hideSolids(shown, planes_);
    shown.dispersion.clear();  // it is in the planes
    if (context_.plan.isExact()) orderByDepthAndBits(shown);
    mix(sample, pass, shown, veil);
  }

  void mix(const PassSettings& sample, int pass, const FragmentLists& lists, Veil& veil) {
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    // Where a pass sees one of two surfaces, its background is a part of the pixel's colour that no mixer knows.
    const Image<glm::vec4>* background = context_.picture.passWeight ? nullptr : &gbuffer.beauty;
    Mixed mixed{sample, pass, gbuffer.data, background, scatters_ ? &planes_ : nullptr, nullptr};
    if (!context_.plan.heldOut) {
      mixer_->mix(mixed, lists, veil);
      return;
    }
    const HeldOutRow heldOut = holdOut(lists, *context_.picture.deepOpaque, fogBeside() && sample.fog);
    const Window& entries = heldOut.lists.window;
    if (entries.width() == 0) return;
    Veil row(entries.width(), 1);
    mixer_->mix({sample, pass, entries, nullptr, nullptr, &heldOut}, heldOut.lists, row);
    addHeldOut(lists.window, heldOut, row, *context_.picture.deepOpaque, mixed.scatter, veil, lookedUp_);
  }

  void showBackground(Veil& veil) {
    const Backdrop backdrop = backdropOf(*context_.picture.centres, planes_.solid);
    const Lookups lookups(backdrop, planes_, context_.plan.lookup);
    if (context_.plan.heldOut)
      showThroughHeldOut(lookups, lookedUp_, veil);
    else
      showThrough(lookups, veil);
  }

  PaintContext context_;
  std::unique_ptr<Mixer> mixer_;
  // Of one pass.
  bool scatters_ = false;
  OitPlanes planes_;           // what scatters
  Image<glm::vec3> lookedUp_;  // with a deep picture behind
  std::optional<LowResolutionFragments> low_;
};

}  // namespace

std::unique_ptr<Painter> listsPainter(const PaintContext& context, std::unique_ptr<Mixer> mixer) {
  return std::make_unique<ListsPainter>(context, std::move(mixer));
}

}  // namespace pellucid
