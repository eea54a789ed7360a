#include "composite/pipeline/sums.h"

#include <optional>

#include "composite/fog.h"
#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/fold_published.h"
#include "composite/pipeline/low_layers.h"
#include "engine_bridge/gl/solid_hash.h"

namespace pellucid {
namespace {

// What a low-resolution pass adds to the counts of a frame.
void countLow(const PassStatistics& low, int factor, PassStatistics& whole) {
  whole.chunks += low.chunks;
  whole.tiles += low.tiles;
  whole.fragments += low.fragments;
  whole.seconds += low.seconds;
  whole.passes += low.passes;
  whole.bitsPerPixel += low.bitsPerPixel / (factor * factor);
  whole.shadowRays += low.shadowRays;
  whole.shadowSeconds += low.shadowSeconds;
}

void addLow(const PaintContext& context, const PassSettings& sample, OitPlanes& planes, PassStatistics& statistics) {
  const int factor = context.plan.lowResolution;
  if (factor == 1) return;
  const LowView view =
      lowViewOf(*context.picture.gbuffer, planes.solid, context.shot.camera, factor, context.picture.planes);
  const OitPlanes low = lowSums(context, view, sample);
  countLow(context.sources.triangles()->statistics(), factor, statistics);
  addLowResolution(low, view, sample.sample, planes, &statistics.clamps);
}

OitPlanes drawnSums(const PaintContext& context, const PassSettings& sample) {
  TransparentPass& pass = *context.sources.triangles();
  PassSettings part = fullResolutionPart(context.plan, sample);
  const bool fogAfter = part.fog && context.plan.isPublished();  // one more layer, once the others are in
  if (fogAfter) part.fog = nullptr;
  OitPlanes planes = pass.accumulate(part);
  PassStatistics statistics = pass.statistics();
  addLow(context, sample, planes, statistics);
  if (fogAfter) addFog(*sample.fog, *context.picture.gbuffer, sample.sample, planes, &statistics.clamps);
  context.counts.add(statistics);
  return planes;
}

// What is drawn at low resolution, as layers of the method that counts them, which reads no number of the pass.
LowResolutionFragments countedTexels(const PaintContext& context, const PassSettings& sample,
                                     PassStatistics& statistics) {
  const std::unique_ptr<Mixer> mixer = methodMixer(*context.plan.counts);
  return lowLayersOf(context, sample, 0, *mixer, statistics);
}

OitPlanes foldedSums(const PaintContext& context, const PassSettings& sample) {
  const GBuffer& gbuffer = *context.picture.gbuffer;
  PassSettings part = fullResolutionPart(context.plan, sample);
  const bool counts = context.plan.counts.has_value();
  if (!counts) part.fog = nullptr;  // it enters the sums as the device has it do, not as runs
  OitPlanes planes = emptySums(context.plan, sample, gbuffer.display, areaOf(sample, gbuffer.data));
  PublishedClamps clamps;
  TransparentPass* pass = context.sources.triangles();
  std::optional<LowResolutionFragments> low;
  PassStatistics texels;
  if (counts && context.plan.lowResolution > 1) low.emplace(countedTexels(context, sample, texels));
  const SourceView view{part, context.picture, VolumeRule::midDepth, low ? &*low : nullptr};
  context.sources.each(view, [&](const FragmentLists& lists) {
    if (!pass) context.counts.fragments += lists.fragments.size();
    foldInto(context.plan, lists, part, planes, clamps);
  });
  PassStatistics statistics = pass ? pass->statistics() : PassStatistics();
  if (low) countLow(texels, context.plan.lowResolution, statistics);
  if (!counts) addLow(context, sample, planes, statistics);
  if (!counts && sample.fog) addFog(*sample.fog, gbuffer, sample.sample, planes, &clamps);
  if (pass) context.counts.add(statistics);
  context.counts.clamps += clamps;
  planes.camera = context.shot.camera;
  planes.info.solidHash = gl::solidHash(planes.solid);
  return planes;
}

}  // namespace

OitPlanes emptySums(const Plan& plan, const PassSettings& sample, const Window& display, const Window& data) {
  OitPlanes planes = plan.isPublished() ? emptyPublishedPlanes(display, data) : emptyPlanes(display, data);
  planes.info.weight = sample.weight;
  planes.info.normalisation = sample.normalisation;
  if (plan.isExact()) planes.info.tier = "exact";
  return planes;
}

void foldInto(const Plan& plan, const FragmentLists& lists, const PassSettings& sample, OitPlanes& planes,
              PublishedClamps& clamps) {
  if (planes.published())
    foldPublished(lists, sample.weight, planes, clamps);
  else if (plan.isExact())
    foldExact(lists, sample.weight, sample.normalisation, planes);
  else
    foldFragments(lists, sample.weight, sample.normalisation, planes);
}

PassSettings fullResolutionPart(const Plan& plan, const PassSettings& sample) {
  PassSettings part = sample;
  if (plan.lowResolution > 1) part.layers = LayerChoice::fullResolution;
  return part;
}

PassSettings lowResolutionPart(const PassSettings& sample) {
  PassSettings part = sample;
  part.layers = LayerChoice::lowResolution;
  part.fog = nullptr;
  return part;
}

OitPlanes lowSums(const PaintContext& context, const LowView& view, const PassSettings& sample) {
  TransparentPass& pass = *context.sources.triangles();
  PassSettings part = lowResolutionPart(sample);
  part.tier = SumsTier::float32;
  if (context.plan.isPublished()) part.normalisation = shading::PLD_NORMALISE_SPECTRAL;
  const DrawnOver over(pass, view, *context.picture.gbuffer, context.shot.camera);
  if (!context.plan.isExact()) return pass.accumulate(part);
  OitPlanes planes = emptySums(context.plan, part, view.gbuffer.display, view.gbuffer.data);
  PublishedClamps none;
  pass.fragments(part, [&](const FragmentLists& lists) { foldInto(context.plan, lists, part, planes, none); });
  return planes;
}

OitPlanes sumsOf(const PaintContext& context, const PassSettings& sample) {
  return context.plan.route == Route::drawnSums ? drawnSums(context, sample) : foldedSums(context, sample);
}

}  // namespace pellucid
