// The order-independent sums of each pass, resolved. Over a deep picture each of its samples has sums of its own.
#include <algorithm>

#include "composite/deep/placed_sums.h"
#include "composite/fog.h"
#include "composite/pipeline/painters/lists_painter.h"
#include "composite/pipeline/resolve_step.h"
#include "composite/pipeline/sums.h"
#include "engine_bridge/gl/solid_hash.h"

namespace pellucid {
namespace {

class SumsPainter : public Painter {
 public:
  explicit SumsPainter(const PaintContext& context) : context_(context) {}

  Veil paint(const PassSettings& sample, int) override {
    Journal& journal = context_.journal;
    const bool drawn = context_.plan.route == Route::drawnSums;
    OitPlanes planes =
        journal.time(drawn ? "transparent pass" : "lists and sums", [&] { return sumsOf(context_, sample); });
    return journal.time("resolve", [&] {
      ResolvePass* device = context_.plan.resolvesOnDevice ? &context_.device.resolver(journal) : nullptr;
      return resolveSums(device, std::move(planes), context_.plan.resolve, context_.plan.lookup,
                         *context_.picture.centres, context_.picture.edges);
    });
  }

 private:
  PaintContext context_;
};

// The sums of the entries of a deep picture's row.
class SumsMixer : public Mixer {
 public:
  //   kept  is given the sums, or null
  explicit SumsMixer(const PaintContext& context, PlacedSums* kept = nullptr) : context_(context), kept_(kept) {
    if (!kept) return;
    const Window places = placesWindow(*context.picture.deepOpaque);
    kept->places = emptySums(context.plan, context.plan.pass, context.picture.deepOpaque->display, places);
  }
  // What diffuses is listed: each sample of the picture is behind some of it.
  bool fogBeside(const Fog& fog) const override { return !fog.diffuses() && !context_.plan.counts; }
  void mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    if (context_.plan.counts)
      methodMixer(*context_.plan.counts)->mixTexels(mixed, lists, veil);
    else
      Mixer::mixTexels(mixed, lists, veil);
  }
  void endPass(const OitPlanes& scatter) override {
    if (kept_) kept_->scatter = scatter;
  }

  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    const Plan& plan = context_.plan;
    OitPlanes planes = emptySums(plan, mixed.sample, lists.window, lists.window);
    foldInto(plan, lists, mixed.sample, planes, context_.counts.clamps);
    if (mixed.sample.fog && fogBeside(*mixed.sample.fog) && mixed.row)
      addFog(*mixed.sample.fog, *context_.picture.gbuffer, mixed.sample.sample, *mixed.row, planes,
             &context_.counts.clamps);
    if (kept_ && mixed.row) putAtPlaces(*mixed.row, planes, kept_->places);
    veil = resolve(planes, plan.resolve);
  }

 private:
  PaintContext context_;
  PlacedSums* kept_;
};

}  // namespace

std::unique_ptr<Painter> sumsPainter(const PaintContext& context) {
  if (context.plan.heldOut) return listsPainter(context, std::make_unique<SumsMixer>(context));
  return std::make_unique<SumsPainter>(context);
}

PlacedSums placedSumsOf(const PaintContext& context, const PassSettings& sample, int pass) {
  PlacedSums sums;
  listsPainter(context, std::make_unique<SumsMixer>(context, &sums))->paint(sample, pass);
  // What scatters is folded in floats, of every tier.
  for (OitPlanes* planes : {&sums.places, &sums.scatter}) {
    if (planes == &sums.scatter && !planes->scatters()) continue;
    planes->camera = context.shot.camera;
    planes->info.weight = sample.weight;
    planes->info.places = placesText(*context.shot.deepOpaque);  // as they are at pixel centres
    planes->info.solidHash = gl::solidHash(planes->solid);
  }
  return sums;
}

}  // namespace pellucid
