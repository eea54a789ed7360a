#include "composite/pipeline/resolve_planes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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
        "--gather: found exact with --diffusion-kernel disc, expected fast: the disc has one gather, and its taps are "
        "few");
  const RimRequest& rims = request.rims;
  if (rims.infer == false && (rims.form || rims.fromFile || rims.radius))
    throw UsageError(
        fmt::format("{}: found it with --occlusion off, expected inferred", rims.form       ? "--occlusion-inference"
                                                                            : rims.fromFile ? "--occlusion-source"
                                                                                            : "--occlusion-radius"));
}

namespace {

// All files' passes, added pass by pass.
std::vector<PassPlanes> readAll(const PlanesRequest& request, Journal& journal) {
  std::vector<PassPlanes> passes = journal.time("read planes", [&] { return readPasses(request.planes[0]); });
  for (std::size_t k = 1; k < request.planes.size(); ++k)
    journal.time("read planes", [&] {
      const std::vector<PassPlanes> more = readPasses(request.planes[k]);
      if (more.size() != passes.size())
        throw MeaningError(fmt::format("{}: found {} passes, expected {} of {}", request.planes[k], more.size(),
                                       passes.size(), request.planes[0]));
      if (!more[0].relit.empty() && !passes[0].relit.empty())
        throw MeaningError(
            fmt::format("{}: found shadows on the picture as in the planes before, expected one such "
                        "file: light that is hidden twice does not add; accumulate them together",
                        request.planes[k]));
      if (!more[0].relit.empty()) passes[0].relit = more[0].relit;
      for (std::size_t i = 0; i < passes.size(); ++i) {
        mergePlanes(passes[i].planes, more[i].planes, request.planes[0], request.planes[k]);
        passes[i].rims.add(more[i].rims);
      }
    });
  return passes;
}

void checkPlanes(const PlanesRequest& request, const OitPlanes& planes, const GBuffer& gbuffer) {
  expectPlanesOf(gbuffer, request.opaque, planes, request.planes[0]);
  if (planes.published())
    for (const LayerName name : request.layers)
      if (name == LayerName::depth || name == LayerName::weight || name == LayerName::count)
        throw UsageError("--layers: found depth, weight or count with the published tier, whose targets hold none");
}

ResolveSettings settingsOf(const PlanesRequest& request, const OitPlanes& planes) {
  ResolveSettings settings;
  settings.selfModulation = request.selfModulation.value_or(planes.published());
  settings.formula = formulaOf(planes.info.method);
  return settings;
}

}  // namespace

ResolvedPlanes resolvePlanes(const PlanesRequest& request, Journal& journal) {
  validate(request);
  ResolvedPlanes result;
  std::vector<PassPlanes> passes = readAll(request, journal);
  const OitPlanes& first = passes[0].planes;
  result.opaque = journal.time("read picture", [&] { return readOpaque(request.opaque, request.read, &first.camera); });
  journal.note(understoodLines(result.opaque));
  journal.note(result.opaque.notes);
  checkPlanes(request, first, result.opaque.gbuffer);
  result.info = first.info;
  GBuffer gbuffer = result.opaque.gbuffer;
  const Image<glm::vec4> relit = passes[0].relit;
  for (std::size_t i = 0; i < relit.size(); ++i)
    gbuffer.beauty[i] = glm::vec4(glm::vec3(relit[i]), gbuffer.beauty[i].a);
  if (std::none_of(passes.begin(), passes.end(), [](const PassPlanes& pass) { return anyLayers(pass.planes); }))
    journal.note(fmt::format("{}: the planes hold no layer: nothing changes", fmt::join(request.planes, ", ")));
  const ResolveSettings settings = settingsOf(request, first);
  Device device(-1);
  const bool onDevice = request.onDevice && settings.formula == SumFormula::mean;
  if (request.onDevice && !onDevice)
    journal.note(
        fmt::format("--resolve gl: planes of method {} are resolved on the CPU: the device has the weighted "
                    "mean alone",
                    first.info.method));
  ResolvePass* resolver = onDevice ? &device.resolver(journal) : nullptr;
  VeilMean mean;
  for (PassPlanes& pass : passes) {
    journal.time("occlusion of leaves", [&] { occludeRims(request.rims, pass.rims, gbuffer, pass.planes, journal); });
    if (&pass == &passes[0] && wantsPlanes(request.layers))
      result.layers.push_back(planeLayer(request.layers, pass.planes));
    mean.add(journal.time(
        "resolve", [&] { return resolveSums(resolver, std::move(pass.planes), settings, request.lookup, gbuffer); }));
  }
  result.veil = journal.time("average", [&] { return mean.finish(); });
  result.picture = journal.time("compose", [&] { return compose(result.veil, gbuffer); });
  for (std::size_t i = 0; i < relit.size(); ++i)
    if (relit[i].a > 0.0f) result.picture.touched[i] = 1;
  std::vector<ExtraLayer> layers = veilLayers(request.layers, result.veil);
  layers.insert(layers.end(), result.layers.begin(), result.layers.end());
  result.layers = std::move(layers);
  result.device = device.description();
  return result;
}

}  // namespace pellucid
