#include "composite/pipeline/resolve_planes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "composite/antialias.h"
#include "composite/deep/placed_sums.h"
#include "composite/edges.h"
#include "composite/moving_light.h"
#include "composite/picture_occluders.h"
#include "composite/pipeline/not_finite.h"
#include "composite/pipeline/nothing_drawn.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/pass_picture.h"
#include "composite/pipeline/resolve_step.h"
#include "composite/pipeline/shot.h"
#include "composite/rims.h"
#include "gbuffer/camera_match.h"
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

const Camera& pictureCameraOf(const PassPlanes& first) {
  return first.pictureCamera ? *first.pictureCamera : first.planes.camera;
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

// The camera that took the picture, of whichever file names it.
void takePictureCamera(const PlanesRequest& request, std::size_t file, const PassPlanes& more, PassPlanes& first) {
  if (!more.pictureCamera) return;
  const Camera& known = pictureCameraOf(first);
  if (!sameView(*more.pictureCamera, known))
    throw MeaningError(fmt::format("{}: camera of the picture: found {}, expected {} as in {}", request.planes[file],
                                   viewText(*more.pictureCamera), viewText(known), request.planes[0]));
  first.pictureCamera = more.pictureCamera;
}

// All files' passes, added pass by pass.
std::vector<PassPlanes> readAll(const PlanesRequest& request, Journal& journal) {
  std::vector<PassPlanes> passes = journal.time("read planes", [&] { return readPasses(request.planes[0]); });
  std::size_t shadows = passes[0].shadow.empty() ? 0 : 1;  // files with a layer `shadow`
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
      if (!more[0].shadow.empty() && ++shadows == 1) passes[0].shadow = std::move(more[0].shadow);
      takePictureCamera(request, k, more[0], passes[0]);
      for (std::size_t i = 0; i < passes.size(); ++i) {
        const double factor = referenceFactor(more[i].planes.info.weight, passes[i].planes.info.weight);
        mergePlanes(passes[i].planes, more[i].planes, request.planes[0], request.planes[k]);
        addScatter(passes[i].scatter, more[i].scatter, request.planes[0], request.planes[k]);
        if (!more[i].now.empty()) passes[i].now = more[i].now;
        if (!scaleWeights(more[i].rims, factor))
          refuseReference(more[i].planes, request.planes[k], passes[i].planes, request.planes[0]);
        passes[i].rims.add(more[i].rims);
      }
    });
  if (shadows > 1) {
    passes[0].shadow = Image<glm::vec3>();
    journal.note(
        fmt::format("{} files of planes have a layer `shadow`, and none is written: what several hide of a "
                    "light does not multiply; accumulate them together",
                    shadows));
  }
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

void checkPlanes(const PlanesRequest& request, const PassPlanes& first, const GBuffer& gbuffer) {
  const OitPlanes& planes = first.planes;
  expectPlanesOf(gbuffer, request.opaque, planes, pictureCameraOf(first), request.planes[0]);
  if (planes.published())
    for (const LayerName name : request.layers)
      if (name == LayerName::depth || name == LayerName::weight || name == LayerName::count)
        throw UsageError("--layers: found depth, weight or count with the published tier, whose targets hold none");
}

// Of which each pass saw one side; none where they saw whole pixels.
std::vector<EdgePixel> edgesOf(const std::vector<PassPlanes>& passes, const GBuffer& gbuffer) {
  if (!passes[0].edges || passes.size() < 2) return {};
  return edgePixels(gbuffer, DepthPlanes(gbuffer, pictureCameraOf(passes[0])));
}

std::vector<glm::dvec2> samplesOf(const std::vector<PassPlanes>& passes) {
  std::vector<glm::dvec2> samples;
  for (std::size_t i = 0; i < passes.size(); ++i)
    samples.push_back(samplePosition(static_cast<int>(i), static_cast<int>(passes.size()), passes[0].pixelFilter));
  return samples;
}

std::unique_ptr<EdgePasses> dealt(const std::vector<EdgePixel>& edges, const std::vector<PassPlanes>& passes) {
  return edges.empty() ? nullptr : std::make_unique<EdgePasses>(edges, samplesOf(passes));
}

// The picture as the passes saw it, where that was from elsewhere than it was taken: what hides light from rims.
class SeenPicture {
 public:
  //   counts  unseenLayer() will be asked for
  SeenPicture(const GBuffer& gbuffer, const std::vector<PassPlanes>& passes, bool counts)
      : gbuffer_(gbuffer),
        lit_{&gbuffer, &gbuffer, nullptr},
        taken_(pictureCameraOf(passes[0])),
        camera_(taken_),
        samples_(samplesOf(passes)),
        counts_(counts) {}
  // In the next pass.
  const GBuffer& seenBy(const PassPlanes& pass, std::size_t index) {
    const bool moved = !sameView(pass.planes.camera, taken_);
    if (!picture_ && (counts_ || (moved && !pass.rims.empty()))) {
      planes_.emplace(gbuffer_, taken_);
      picture_.emplace(lit_, &*planes_, nullptr, nullptr, camera_, gbuffer_.data);
      if (counts_) picture_->countUnseen();
    }
    camera_ = pass.planes.camera;
    if (picture_) picture_->moveTo(samples_[index], static_cast<int>(index));
    return moved && picture_ ? *picture_->picture().gbuffer : gbuffer_;
  }
  // 0 everywhere over a deep picture, whose samples stay where they are.
  ExtraLayer layer() const {
    return unseenLayer(picture_ ? picture_->unseenShare()
                                : Image<float>(gbuffer_.data.width(), gbuffer_.data.height(), 0.0f));
  }

 private:
  const GBuffer& gbuffer_;
  LitPicture lit_;
  Camera taken_, camera_;
  std::vector<glm::dvec2> samples_;
  bool counts_;
  std::optional<DepthPlanes> planes_;
  std::optional<PassPicture> picture_;
};

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
//   gbuffer  as it is lit in the pass
//   met      edges that bent rays may meet in it; null: none
Veil veilOfPixels(const PlanesRequest& request, PassPlanes& pass, const ResolveSettings& settings,
                  const GBuffer& gbuffer, const GBuffer& occluding, const EdgeTexels* met, ResolvePass* resolver,
                  Journal& journal) {
  journal.time("occlusion of leaves", [&] { occludeRims(request.rims, pass.rims, occluding, pass.planes, journal); });
  return journal.time(
      "resolve", [&] { return resolveSums(resolver, std::move(pass.planes), settings, request.lookup, gbuffer, met); });
}

// Puts a picture's colours as shadows have left them into it; nothing where there are none.
void lightBy(const Image<glm::vec4>& colours, GBuffer& gbuffer) {
  for (std::size_t i = 0; i < colours.size(); ++i)
    gbuffer.beauty[i] = glm::vec4(glm::vec3(colours[i]), gbuffer.beauty[i].a);
}

// Reads the picture that the planes belong to, and checks that they do.
GBuffer readBackground(const PlanesRequest& request, const PassPlanes& first, ResolvedPlanes& result,
                       std::unique_ptr<DeepOpaque>& deep, Journal& journal) {
  const OitPlanes& planes = first.planes;
  const Camera& camera = pictureCameraOf(first);
  result.opaque =
      journal.time("read picture", [&] { return readPictureFile(request.opaque, request.read, &camera, deep); });
  expectSpaceOf(result.opaque.space, request.opaque, planes, request.planes[0]);
  result.opaque.space = planes.info.space;
  result.camera = camera;
  result.info = planes.info;
  if (!deep) journal.note(understoodLines(result.opaque));
  journal.note(result.opaque.notes);
  checkPlaces(request, planes, deep.get());
  checkPlanes(request, first, result.opaque.gbuffer);
  if (deep) checkRims(request.rims, false);
  GBuffer gbuffer = result.opaque.gbuffer;
  lightBy(first.relit, gbuffer);
  return gbuffer;
}

std::vector<ExtraLayer> planeLayers(const PlanesRequest& request, const std::vector<PassPlanes>& passes,
                                    Journal& journal) {
  if (!wantsPlanes(request.layers)) return {};
  if (passes.size() > 1)
    journal.note(
        fmt::format("--layers: D, delta, weight and count are those of the first of {} passes, beside the pixels' "
                    "centres",
                    passes.size()));
  return {planeLayer(request.layers, passes[0].planes)};
}

}  // namespace

ResolvedPlanes resolvePlanes(const PlanesRequest& request, Journal& journal) {
  validate(request);
  ResolvedPlanes result;
  std::vector<PassPlanes> passes = readAll(request, journal);
  std::unique_ptr<DeepOpaque> deep;
  const GBuffer gbuffer = readBackground(request, passes[0], result, deep, journal);
  const Image<glm::vec4> relit = passes[0].relit;
  const Image<glm::vec3> shadow = passes[0].shadow;
  if (std::none_of(passes.begin(), passes.end(), [](const PassPlanes& pass) { return anyLayers(pass.planes); }))
    journal.note(fmt::format("{}: the planes hold no layer: nothing changes", fmt::join(request.planes, ", ")));
  const ResolveSettings settings = settingsOf(request, passes[0].planes);
  Device device(-1);
  ResolvePass* resolver = resolverFor(request, settings, result.info.method, deep != nullptr, device, journal);
  const std::vector<ExtraLayer> ofPlanes = planeLayers(request, passes, journal);
  const std::vector<EdgePixel> pixels = journal.time("edges", [&] { return edgesOf(passes, result.opaque.gbuffer); });
  const std::unique_ptr<EdgePasses> edges = dealt(pixels, passes);
  const bool wantsUnseen = asks(request.layers, LayerName::unseen);
  SeenPicture picture(gbuffer, passes, wantsUnseen && !deep);
  VeilMean mean;
  MovingLight moving;
  std::optional<EdgeTexels> met;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    PassPlanes& pass = passes[i];
    std::optional<GBuffer> lit;  // where the pass has light of its own
    if (!pass.now.empty()) lightBy(pass.now, lit.emplace(gbuffer));
    const GBuffer& background = lit ? *lit : gbuffer;
    if (edges) met = edges->texelsOf(static_cast<int>(i), background.beauty);
    Veil veil =
        deep
            ? journal.time(
                  "resolve",
                  [&] { return resolvePlaces(pass.planes, pass.scatter, settings, request.lookup, *deep, background); })
            : veilOfPixels(request, pass, settings, background, picture.seenBy(pass, i), met ? &*met : nullptr,
                           resolver, journal);
    if (edges) edges->weigh(static_cast<int>(i), veil);
    moving.add(veil, lit ? &lit->beauty : nullptr, gbuffer.beauty);
    mean.add(std::move(veil));
  }
  result.veil = journal.time("average", [&] { return mean.finish(); });
  if (edges) edges->finish(result.veil);
  moving.finish(result.veil);
  result.picture = journal.time("compose", [&] { return compose(result.veil, gbuffer); });
  noteWhatIsNotFinite(result.picture, result.veil, gbuffer, journal);
  for (std::size_t i = 0; i < relit.size(); ++i)
    if (relit[i].a > 0.0f) result.picture.touched[i] = 1;
  result.layers = veilLayers(request.layers, result.veil);
  if (!shadow.empty()) result.layers.push_back(shadowLayer(shadow));
  result.layers.insert(result.layers.end(), ofPlanes.begin(), ofPlanes.end());
  if (wantsUnseen) result.layers.push_back(picture.layer());
  if (asks(request.layers, LayerName::edges)) result.layers.push_back(edgesLayer(result.opaque.gbuffer, &pixels));
  result.device = device.description();
  return result;
}

}  // namespace pellucid
