#include "composite/pipeline/painters/lists_painter.h"

#include <algorithm>
#include <cmath>
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
  bool showsLater() const override { return lookups_ != nullptr; }
  void showBackground(Veil& rows) override {
    const int top = rows.place.y - (area_.y0 - context_.picture.gbuffer->data.y0);
    context_.journal.time("background", [&] { showThrough(*lookups_, rows, top); });
  }
  bool settled() override { return mixer_->settled(); }
  void finish(Veil& mean) override { mixer_->finish(mean); }

 private:
  Veil painted(const PassSettings& sample, int pass) {
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    const Plan& plan = context_.plan;
    area_ = areaOf(sample, gbuffer.data);
    lookups_.reset();
    Veil veil(area_, gbuffer.data);
    if (leanWillDo(sample)) {
      context_.sources.triangles()->leanFragments(sample,
                                                  [&](const LeanLists& lists) { mixer_->mixLean(lists, area_, veil); });
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
    anyScatters_ = false;
    preparePlanes();
    list(sample, pass, veil);
    if (TransparentPass* triangles = context_.sources.triangles()) {
      PassStatistics statistics = triangles->statistics();
      statistics.fragments += lowStatistics.fragments;
      statistics.passes += lowStatistics.passes;
      context_.counts.add(statistics);
    }
    low_.reset();
    mixer_->endPass(planes_);
    if (planes_.scatters() && (!planesStay() || anyScatters_)) prepareBackground(veil);
    return veil;
  }

  // Whether what scatters is summed so that no order shows: each window replaces what the pass before has left there.
  bool sumsExactly() const { return mixer_->exactScatter() || context_.plan.isExact(); }
  bool planesStay() const { return sumsExactly() && !context_.plan.heldOut; }

  void preparePlanes() {
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    if (!scatters_)
      planes_ = OitPlanes();
    else if (!planesStay())
      planes_ = emptyPlanes(gbuffer.display, area_);
    else if (planes_.data != area_ || !planes_.scatters())
      planes_ = emptyScatterPlanes(gbuffer.display, area_);
  }

  void list(const PassSettings& sample, int pass, Veil& veil) {
    PassSettings listed = fullResolutionPart(context_.plan, sample);
    if (fogBeside(sample)) listed.fog = nullptr;
    const SourceView view{listed, context_.picture, mixer_->rule(), low_ ? &*low_ : nullptr};
    const ListSink mixes = [&](const FragmentLists& lists) {
      if (!context_.sources.triangles()) context_.counts.fragments += lists.fragments.size();
      window(sample, pass, lists, veil);
    };
    context_.sources.each(view, mixes);
  }

  // Mixers that read depths and colours alone, where nothing but triangles is there.
  bool leanWillDo(const PassSettings& sample) const {
    return mixer_->takesLean() && !context_.plan.heldOut && context_.sources.trianglesAlone() &&
           context_.plan.lowResolution == 1 && !context_.sources.mayScatter(sample);
  }

  bool fogBeside(const PassSettings& sample) const {
    return context_.plan.heldOut && sample.fog && mixer_->fogBeside(*sample.fog);
  }

  void window(const PassSettings& sample, int pass, const FragmentLists& given, Veil& veil) {
    // Every method shows the same background, which the pixel's scattering layers alone decide.
    if (scatters_ && planesStay())
      anyScatters_ = foldExactScattering(given, planes_) || anyScatters_;
    else if (scatters_ && sumsExactly())
      foldExact(given, sample.weight, sample.normalisation, planes_);
    else if (scatters_)
      foldScattering(given, planes_);
    if (!context_.plan.isExact() && !(scatters_ && (given.hasColumns() || hidesSolids(given, planes_)))) {
      mix(sample, pass, given, veil);
      return;
    }
    shown_ = given;
    shown_.clearColumns();  // what they tell is in the planes
    if (scatters_) hideSolids(shown_, planes_);
    if (context_.plan.isExact()) orderByDepthAndBits(shown_);
    mix(sample, pass, shown_, veil);
  }

  void mix(const PassSettings& sample, int pass, const FragmentLists& lists, Veil& veil) {
    // Where a pass sees one of two surfaces, its background is a part of the pixel's colour that no mixer knows.
    const bool ofPixels = !context_.picture.passWeight && area_ == context_.picture.gbuffer->data;
    const Image<glm::vec4>* background = ofPixels ? &context_.picture.centres->beauty : nullptr;
    Mixed mixed{sample, pass, area_, background, scatters_ ? &planes_ : nullptr, nullptr};
    if (!context_.plan.heldOut) {
      mixer_->mix(mixed, lists, veil);
      return;
    }
    const HeldOutRow heldOut =
        holdOut(lists, *context_.picture.deepOpaque, fogBeside(sample),
                mixer_->rule() == VolumeRule::split ? VolumeCuts::atLayers : VolumeCuts::halfWay);
    const Window& entries = heldOut.lists.window;
    if (entries.width() == 0) return;
    Veil row(entries.width(), 1);
    mixer_->mix({sample, pass, entries, nullptr, nullptr, &heldOut}, heldOut.lists, row);
    addHeldOut(lists.window, heldOut, row, *context_.picture.deepOpaque, mixed.scatter, veil, lookedUp_);
  }

  // Of a flat picture the lookups alone are made ready: what all of its pixels show takes as much memory as the veil.
  void prepareBackground(Veil& veil) {
    const GBuffer& picture = *context_.picture.centres;
    const glm::ivec2 place(planes_.data.x0 - picture.data.x0, planes_.data.y0 - picture.data.y0);
    lookups_ = std::make_unique<Lookups>(backdrops_.of(picture, planes_.solid, place), planes_, context_.plan.lookup,
                                         place, context_.picture.edges);
    if (!context_.plan.heldOut) return;
    showThroughHeldOut(*lookups_, lookedUp_, veil);
    lookups_.reset();
  }

  PaintContext context_;
  std::unique_ptr<Mixer> mixer_;
  // Of one pass.
  Window area_;
  bool scatters_ = false, anyScatters_ = false;  // may be, is
  OitPlanes planes_;                             // what scatters
  FragmentLists shown_;                          // of a window, where it is not shown as it is listed
  PassBackdrop backdrops_;
  std::unique_ptr<Lookups> lookups_;  // of planes_ and backdrops_
  Image<glm::vec3> lookedUp_;         // with a deep picture behind
  std::optional<LowResolutionFragments> low_;
};

}  // namespace

std::unique_ptr<Painter> listsPainter(const PaintContext& context, std::unique_ptr<Mixer> mixer) {
  return std::make_unique<ListsPainter>(context, std::move(mixer));
}

}  // namespace pellucid
