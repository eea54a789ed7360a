#include "composite/pipeline/resolve_planes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "composite/occluders.h"
#include "composite/pipeline/nothing_drawn.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/resolve_step.h"
#include "composite/rims.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"
#include "gbuffer/planes_match.h"

namespace pellucid {
namespace {

void checkRims(const RimRequest& request, bool apart) {
  const std::pair<bool, const char*> given[] = {{request.infer.has_value(), "--occlusion"},
                                                {request.form.has_value(), "--occlusion-inference"},
                                                {request.fromFile.has_value(), "--occlusion-source"},
                                                {request.radius.has_value(), "--occlusion-radius"}};
  for (const auto& [isGiven, flag] : given)
    if (isGiven && !apart)
      throw UsageError(
          fmt::format("{}: the planes carry no rims apart, expected those of accumulate --occlusion apart", flag));
}

// Takes from the sums what the opaque pixels beside the rims hide.
void occludeRims(const RimRequest& request, const RimPlanes& rims, const GBuffer& gbuffer, OitPlanes& planes,
                 Journal& journal) {
  checkRims(request, !rims.empty());
  if (rims.empty() || !request.infer.value_or(true)) return;
  Image<float> solidZ(planes.solid.width(), planes.solid.height());
  for (std::size_t i = 0; i < solidZ.size(); ++i) solidZ[i] = planes.solid[i].a;
  OccluderSettings how;
  how.fromFile = request.fromFile.value_or(true);
  how.screen.radius = request.radius.value_or(0.0);
  std::size_t pixels = 0;
  const OccluderPlanes occluders =
      occludersOf(gbuffer, planes.camera, nearestSolids(gbuffer, solidZ), how, nullptr, pixels);
  const std::size_t found =
      occludeRims(rims, occluders, request.form.value_or(shading::PLD_OCCLUSION_RELATIVE), planes);
  journal.note(fmt::format("leaves: rims of {} pixels occluded{}", found,
                           pixels > 0 ? fmt::format(", by the occlusion of {} pixels from depth alone", pixels) : ""));
}

}  // namespace

void validate(const PlanesRequest& request) {
  if (request.lookup.exact && request.lookup.kernel == shading::PLD_DIFFUSE_DISC)
    throw UsageError(
        "--gather exact: found it with --diffusion-kernel disc: the disc has one gather, and its taps are "
        "few");
  const RimRequest& rims = request.rims;
  if (rims.infer == false && (rims.form || rims.fromFile || rims.radius))
    throw UsageError(
        fmt::format("{}: found it with --occlusion off, expected inferred", rims.form       ? "--occlusion-inference"
                                                                            : rims.fromFile ? "--occlusion-source"
                                                                                            : "--occlusion-radius"));
}

ResolvedPlanes resolvePlanes(const PlanesRequest& request, Journal& journal) {
  validate(request);
  ResolvedPlanes result;
  result.opaque = journal.time("read picture", [&] { return readOpaque(request.opaque, request.read); });
  journal.note(result.opaque.notes);
  const GBuffer& gbuffer = result.opaque.gbuffer;
  RimPlanes rims;
  OitPlanes planes = journal.time("read planes", [&] { return readPlanes(request.planes[0], &rims); });
  for (std::size_t i = 1; i < request.planes.size(); ++i)
    journal.time("read planes", [&] {
      RimPlanes more;
      mergePlanes(planes, readPlanes(request.planes[i], &more), request.planes[0], request.planes[i]);
      rims.add(more);
    });
  expectPlanesOf(gbuffer, request.opaque, planes, request.planes[0]);
  if (!anyLayers(planes))
    journal.note(fmt::format("{}: the planes hold no layer: nothing changes", fmt::join(request.planes, ", ")));
  journal.time("occlusion of leaves", [&] { occludeRims(request.rims, rims, gbuffer, planes, journal); });
  result.info = planes.info;
  if (planes.published())
    for (const LayerName name : request.layers)
      if (name == LayerName::depth || name == LayerName::weight || name == LayerName::count)
        throw UsageError("--layers: found depth, weight or count with the published tier, whose targets hold none");
  ResolveSettings settings;
  settings.selfModulation = request.selfModulation.value_or(planes.published());
  settings.formula = formulaOf(planes.info.method);
  Device device(-1);
  const bool onDevice = request.onDevice && settings.formula == SumFormula::mean;
  if (request.onDevice && !onDevice)
    journal.note(
        fmt::format("--resolve gl: planes of --method {} are resolved on the CPU: the device has the weighted "
                    "mean alone",
                    planes.info.method));
  ResolvePass* resolver = onDevice ? &device.resolver(journal) : nullptr;
  result.veil =
      journal.time("resolve", [&] { return resolveSums(resolver, planes, settings, request.lookup, gbuffer); });
  result.picture = journal.time("compose", [&] { return compose(result.veil, gbuffer); });
  result.layers = veilLayers(request.layers, result.veil);
  if (wantsPlanes(request.layers)) result.layers.push_back(planeLayer(request.layers, planes));
  result.device = device.description();
  return result;
}

}  // namespace pellucid
