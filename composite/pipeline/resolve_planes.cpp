#include "composite/pipeline/resolve_planes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "composite/antialias.h"
#include "composite/deep/placed_sums.h"
#include "composite/edges.h"
#include "composite/picture_occluders.h"
#include "composite/pipeline/not_finite.h"
#include "composite/pipeline/nothing_drawn.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/resolve_step.h"
#include "composite/pipeline/shot.h"
#include "composite/rims.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"
#include "gbuffer/planes_match.h"
#include "gbuffer/weight_reference.h"

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

// Of a deep picture: what scatters in either.
void addScatter(OitPlanes& sum, const OitPlanes& more, const std::string& file, const std::string& other) {
  if (!more.scatters()) return;
  if (sum.scatters())
    mergePlanes(sum, more, file, other);
  else
    sum = more;
}

// All files' passes, added pass by pass.
std::vector<PassPlanes> readAll(const PlanesRequest& request, Journal& journal) {
  std::vector<PassPlanes> passes = journal.time("read planes", [&] { return readPasses(request.planes[0]); });
  for (std::size_t k = 1; k < request.planes.size(); ++k)
    journal.time("read planes", [&] {
      std::vector<PassPlanes> more = readPasses(request.planes[k]);
      if (more.size() != passes.size())
        throw MeaningError(fmt::format("{}: found {} passes, expected {} of {}", request.planes[k], more.size(),
                                       passes.size(), request.planes[0]));
      if (!more[0].relit.empty() && !passes[0].relit.empty())
        throw MeaningError(
            fmt::format("{}: found shadows on the picture as in the planes before, expected one such "
                        "file: light that is hidden twice does not add; accumulate them together",
                        request.planes[k]));
      if (more[0].edges != passes[0].edges)
        throw MeaningError(fmt::format("{}: edges: found {}, expected {} as in {}", request.planes[k],
                                       more[0].edges ? "resolve" : "off", passes[0].edges ? "resolve" : "off",
                                       request.planes[0]));
      if (more[0].pixelFilter != passes[0].pixelFilter)
        throw MeaningError(fmt::format("{}: pixel filter: found {}, expected {} as in {}", request.planes[k],
                                       filterText(more[0].pixelFilter), filterText(passes[0].pixelFilter),
                                       request.planes[0]));
      if (!more[0].relit.empty()) passes[0].relit = more[0].relit;
      for (std::size_t i = 0; i < passes.size(); ++i) {
        const double factor = referenceFactor(more[i].planes.info.weight, passes[i].planes.info.weight);
        mergePlanes(passes[i].planes, more[i].planes, request.planes[0], request.planes[k]);
        addScatter(passes[i].scatter, more[i].scatter, request.planes[0], request.planes[k]);
        if (!scaleWeights(more[i].rims, factor))
          refuseReference(more[i].planes, request.planes[k], passes[i].planes, request.planes[0]);
        passes[i].rims.add(more[i].rims);
      }
    });
  return passes;
}

// Planes of places belong to that deep picture alone.
void checkPlaces(const PlanesRequest& request, const OitPlanes& planes, const DeepOpaque* deep) {
  const std::string found = planes.info.places.empty() ? "pixels of a flat picture" : planes.info.places,
                    expected = deep ? placesText(*deep) : "pixels of a flat picture";
  if (found != expected)
    throw MeaningError(fmt::format("{}: found planes of {}, expected {} as {} has", request.planes[0], found, expected,
                                   request.opaque));
  if (deep && planes.data != placesWindow(*deep))
    throw MeaningError(fmt::format("{}: data window: found {} x {} places, expected {} rows of {} as {} has",
                                   request.planes[0], planes.data.width(), planes.data.height(),
                                   placesWindow(*deep).height(), placesWindow(*deep).width(), request.opaque));
  if (deep && wantsPlanes(request.layers))
    throw MeaningError(
        fmt::format("{}: --layers: found diffusion, delta, weight or count with a deep picture, expected transparent "
                    "or transmission: each sample has planes of its own",
                    request.opaque));
}

void checkPlanes(const PlanesRequest& request, const OitPlanes& planes, const GBuffer& gbuffer) {
  expectPlanesOf(gbuffer, request.opaque, planes, request.planes[0]);
  if (planes.published())
    for (const LayerName name : request.layers)
      if (name == LayerName::depth || name == LayerName::weight || name == LayerName::count)
        throw UsageError("--layers: found depth, weight or count with the published tier, whose targets hold none");
}

// Of which each pass saw one side; none where they saw whole pixels.
std::vector<EdgePixel> edgesOf(const std::vector<PassPlanes>& passes, const GBuffer& gbuffer) {
  if (!passes[0].edges || passes.size() < 2) return {};
  return edgePixels(gbuffer, DepthPlanes(gbuffer, passes[0].planes.camera));
}

std::unique_ptr<EdgePasses> dealt(const std::vector<EdgePixel>& edges, const std::vector<PassPlanes>& passes) {
  if (edges.empty()) return nullptr;
  std::vector<glm::dvec2> samples;
  for (std::size_t i = 0; i < passes.size(); ++i)
    samples.push_back(samplePosition(static_cast<int>(i), static_cast<int>(passes.size()), passes[0].pixelFilter));
  return std::make_unique<EdgePasses>(edges, std::move(samples));
}

ResolveSettings settingsOf(const PlanesRequest& request, const OitPlanes& planes) {
  ResolveSettings settings;
  settings.selfModulation = request.selfModulation.value_or(planes.published());
  settings.formula = formulaOf(planes.info.method);
  return settings;
}

// The device that resolves, or null for the CPU, with a note where it was asked for in vain.
ResolvePass* resolverFor(const PlanesRequest& request, const ResolveSettings& settings, const std::string& method,
                         bool deep, Device& device, Journal& journal) {
  if (!request.onDevice) return nullptr;
  if (!deep && settings.formula == SumFormula::mean) return &device.resolver(journal);
  journal.note(
      deep ? "--resolve gl: each sample of a deep picture has sums of its own, which the CPU resolves"
           : fmt::format("--resolve gl: planes of method {} are resolved on the CPU: the device has the weighted mean "
                         "alone",
                         method));
  return nullptr;
}

// One pass of a flat picture.
Veil veilOfPixels(const PlanesRequest& request, PassPlanes& pass, const ResolveSettings& settings,
                  const GBuffer& gbuffer, ResolvePass* resolver, Journal& journal) {
  journal.time("occlusion of leaves", [&] { occludeRims(request.rims, pass.rims, gbuffer, pass.planes, journal); });
  return journal.time("resolve",
                      [&] { return resolveSums(resolver, std::move(pass.planes), settings, request.lookup, gbuffer); });
}

// Reads the picture that the planes belong to, and checks that they do.
GBuffer readBackground(const PlanesRequest& request, const PassPlanes& first, ResolvedPlanes& result,
                       std::unique_ptr<DeepOpaque>& deep, Journal& journal) {
  const OitPlanes& planes = first.planes;
  result.opaque =
      journal.time("read picture", [&] { return readPictureFile(request.opaque, request.read, &planes.camera, deep); });
  expectSpaceOf(result.opaque.space, request.opaque, planes, request.planes[0]);
  result.opaque.space = planes.info.space;
  result.camera = planes.camera;
  result.info = planes.info;
  if (!deep) journal.note(understoodLines(result.opaque));
  journal.note(result.opaque.notes);
  checkPlaces(request, planes, deep.get());
  checkPlanes(request, planes, result.opaque.gbuffer);
  if (deep) checkRims(request.rims, false);
  GBuffer gbuffer = result.opaque.gbuffer;
  for (std::size_t i = 0; i < first.relit.size(); ++i)
    gbuffer.beauty[i] = glm::vec4(glm::vec3(first.relit[i]), gbuffer.beauty[i].a);
  return gbuffer;
}

}  // namespace

ResolvedPlanes resolvePlanes(const PlanesRequest& request, Journal& journal) {
  validate(request);
  ResolvedPlanes result;
  std::vector<PassPlanes> passes = readAll(request, journal);
  std::unique_ptr<DeepOpaque> deep;
  const GBuffer gbuffer = readBackground(request, passes[0], result, deep, journal);
  const Image<glm::vec4> relit = passes[0].relit;
  if (std::none_of(passes.begin(), passes.end(), [](const PassPlanes& pass) { return anyLayers(pass.planes); }))
    journal.note(fmt::format("{}: the planes hold no layer: nothing changes", fmt::join(request.planes, ", ")));
  const ResolveSettings settings = settingsOf(request, passes[0].planes);
  Device device(-1);
  ResolvePass* resolver = resolverFor(request, settings, result.info.method, deep != nullptr, device, journal);
  std::vector<ExtraLayer> ofPlanes;
  if (wantsPlanes(request.layers)) ofPlanes.push_back(planeLayer(request.layers, passes[0].planes));
  const std::vector<EdgePixel> pixels = journal.time("edges", [&] { return edgesOf(passes, result.opaque.gbuffer); });
  const std::unique_ptr<EdgePasses> edges = dealt(pixels, passes);
  VeilMean mean;
  for (PassPlanes& pass : passes) {
    Veil veil =
        deep ? journal.time(
                   "resolve",
                   [&] { return resolvePlaces(pass.planes, pass.scatter, settings, request.lookup, *deep, gbuffer); })
             : veilOfPixels(request, pass, settings, gbuffer, resolver, journal);
    if (edges) edges->weigh(static_cast<int>(&pass - passes.data()), veil);
    mean.add(std::move(veil));
  }
  result.veil = journal.time("average", [&] { return mean.finish(); });
  if (edges) edges->finish(result.veil);
  result.picture = journal.time("compose", [&] { return compose(result.veil, gbuffer); });
  noteWhatIsNotFinite(result.picture, gbuffer, journal);
  for (std::size_t i = 0; i < relit.size(); ++i)
    if (relit[i].a > 0.0f) result.picture.touched[i] = 1;
  result.layers = veilLayers(request.layers, result.veil);
  result.layers.insert(result.layers.end(), ofPlanes.begin(), ofPlanes.end());
  if (asks(request.layers, LayerName::edges)) result.layers.push_back(edgesLayer(result.opaque.gbuffer, &pixels));
  result.device = device.description();
  return result;
}

}  // namespace pellucid
