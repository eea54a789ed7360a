#include "composite/pipeline/compositor.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "composite/antialias.h"
#include "composite/pipeline/fit.h"
#include "composite/pipeline/foliage_step.h"
#include "composite/pipeline/held_out_planes.h"
#include "composite/pipeline/nothing_drawn.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/pass_picture.h"
#include "composite/pipeline/sums.h"
#include "composite/pipeline/weight_file.h"
#include "gbuffer/errors.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

// Requests of one light may share it.
bool sameLight(const Request& a, const Request& b) {
  return a.passes == b.passes && a.particleLight == b.particleLight && a.shadows == b.shadows && a.fog == b.fog;
}

// Whether a power of depth needs to know where the layers begin.
bool asksDepths(const SumsRequest& sums) {
  const DepthWeight* row = sums.weight ? depthWeightOf(sums.weight->kind) : nullptr;
  return !sums.weightReference && (sums.fitWeight || (row && row->reference == WeightReference::depth));
}

// The beauty as shadows leave it, for a file of planes; empty where they changed nothing.
Image<glm::vec4> relitPicture(const Lighting& lighting) {
  Image<glm::vec4> relit;
  if (lighting.relit.beauty.empty()) return relit;
  relit = lighting.relit.beauty;
  for (std::size_t i = 0; i < relit.size(); ++i) relit[i].a = lighting.shadows.touched[i] ? 1.0f : 0.0f;
  return relit;
}

// What sums over a deep picture cannot hold.
void expectPlacesHold(const Request& request) {
  const auto refuse = [&](const char* flag, const char* expected, const char* why) {
    throw MeaningError(
        fmt::format("{}: {}: found it with a deep picture, expected {}: {}", request.shot.opaque, flag, expected, why));
  };
  if (request.foliage.rule == FoliageRule::apart)
    refuse("--occlusion apart", "inferred", "rims have pixels beside them, samples have none");
  if (!request.heldOutBy.empty())
    refuse("--held-out-by", "all scenes at once", "every sample holds layers out on its own");
  if (request.shadows.apply)
    refuse("--apply-shadows", "composite", "planes hold no samples of the picture that could be dimmed");
}

// While it lives, the pass draws over another depth of the same picture. Without a pass there is nothing to draw.
class DrawnOverPicture {
 public:
  DrawnOverPicture(TransparentPass* pass, const GBuffer& drawnOver, const GBuffer& own, const Camera& camera)
      : pass_(pass), own_(own), camera_(camera) {
    if (pass_) pass_->over(drawnOver, camera);
  }
  ~DrawnOverPicture() {
    if (pass_) pass_->over(own_, camera_);
  }
  DrawnOverPicture(const DrawnOverPicture&) = delete;
  DrawnOverPicture& operator=(const DrawnOverPicture&) = delete;

 private:
  TransparentPass* pass_;
  const GBuffer& own_;
  const Camera& camera_;
};

}  // namespace

struct Compositor::Run {
  Plan plan;
  const Lighting* lighting = nullptr;
  PassSettings pass;  // with the light
  std::unique_ptr<LayerSources> sources;
};

Compositor::Compositor(const Request& request, std::function<void(const std::string&)> sink)
    : journal_(std::move(sink)), device_(request.device) {
  validate(request);
  shot_ = loadShot(request.shot, meetsRays(request), journal_);
  facts_ = factsOf(*shot_);
}

Compositor::~Compositor() = default;

Plan Compositor::plan(const Request& request) const {
  validate(request);
  const Request weighed = weighedByFile(request);
  if (asksDepths(weighed.sums) && !knowsDepths_) {
    addLayerDepths(*shot_, facts_);
    knowsDepths_ = true;
  }
  return planFor(weighed, facts_);
}

TransparentPass* Compositor::triangles() {
  if (shot_->hasScene && !triangles_) {
    GlContext& context = device_.context(journal_);
    triangles_ = journal_.time("upload", [&] {
      return std::make_unique<TransparentPass>(context, shot_->scene, shot_->opaque.gbuffer, shot_->camera);
    });
  }
  return triangles_.get();
}

const DepthPlanes* Compositor::depthPlanes(int passes) {
  if (passes == 1 || shot_->deepOpaque) return nullptr;
  if (!depthPlanes_)
    depthPlanes_ = journal_.time("depth planes",
                                 [&] { return std::make_unique<DepthPlanes>(shot_->opaque.gbuffer, shot_->camera); });
  return depthPlanes_.get();
}

const std::vector<EdgePixel>& Compositor::edges() {
  if (!edges_) edges_ = journal_.time("edges", [&] { return edgePixels(shot_->opaque.gbuffer, *depthPlanes(2)); });
  return *edges_;
}

std::unique_ptr<EdgePasses> Compositor::edgePasses(const Plan& plan) {
  if (!plan.edges) return nullptr;
  std::vector<glm::dvec2> samples;
  for (int i = 0; i < plan.passes; ++i) samples.push_back(samplePass(plan.pass, plan, i).sample);
  return std::make_unique<EdgePasses>(edges(), std::move(samples));
}

const Lighting& Compositor::lightOf(const Request& request) {
  if (!lighting_ || !sameLight(lit_, request)) {
    lighting_ = lightShot(request, *shot_, device_, journal_);
    lit_ = request;
  }
  return *lighting_;
}

Compositor::Run Compositor::prepare(const Request& request) {
  Run run;
  run.plan = plan(request);
  journal_.note(run.plan.notes);
  run.lighting = &lightOf(request);
  run.pass = run.plan.pass;
  run.lighting->applyTo(run.pass, *shot_);
  TransparentPass* pass = triangles();
  run.sources = std::make_unique<LayerSources>(pass);
  if (!shot_->deep.empty()) run.sources->join(deepFiles(shot_->deep));
  if (run.lighting->fog) run.sources->join(fogRuns());
  if (pass) placeOccluders(request.foliage, run.pass, *pass, *run.lighting->picture.gbuffer, shot_->camera, journal_);
  if (run.plan.fitsWeight) {
    RunCounts unused;
    const PaintContext context{run.plan, *shot_, run.lighting->picture, *run.sources, device_, journal_, unused};
    run.pass.weight = run.plan.pass.weight = fittedWeight(context, run.pass);
  }
  return run;
}

Veil Compositor::paint(const Plan& plan, const PassSettings& pass, const Run& run, Journal& journal,
                       RunCounts& counts) {
  const std::unique_ptr<EdgePasses> edges = edgePasses(plan);
  PassPicture moving(run.lighting->picture, depthPlanes(plan.passes), edges.get(), triangles(), shot_->camera);
  const PaintContext context{plan, *shot_, moving.picture(), *run.sources, device_, journal, counts};
  const std::unique_ptr<Painter> painter = makePainter(context);
  VeilMean mean;
  do {
    mean = VeilMean();
    for (int i = 0; i < plan.passes; ++i) {
      const PassSettings sample = samplePass(pass, plan, i);
      moving.moveTo(sample.sample, i);
      Veil veil = painter->paint(sample, i);
      journal.time("average", [&] {
        if (edges) edges->weigh(i, veil);
        mean.add(std::move(veil));
      });
    }
  } while (!painter->settled());
  return journal.time("average", [&] {
    Veil veil = mean.finish();
    if (edges) edges->finish(veil);
    painter->finish(veil);
    return veil;
  });
}

Result Compositor::run(const Request& request) {
  const Run run = prepare(request);
  Result result;
  result.plan = run.plan;
  result.veil = paint(run.plan, run.pass, run, journal_, result.counts);
  const GBuffer& gbuffer = *run.lighting->picture.gbuffer;
  result.dataWindow = gbuffer.data;
  result.picture = journal_.time("compose", [&] { return compose(result.veil, gbuffer); });
  const Image<std::uint8_t>& shadowed = run.lighting->shadows.touched;
  for (std::size_t i = 0; i < shadowed.size(); ++i) result.picture.touched[i] |= shadowed[i];
  if (!anyTouched(result.picture.touched)) noteThatNothingShows(*shot_, journal_);
  if (request.measure) {
    Journal truth = journal_.beside();
    RunCounts unused;
    const Image<glm::vec4> exact = compose(paint(truthOf(run.plan), run.pass, run, truth, unused), gbuffer).rgba;
    result.error = measureError(result.picture.rgba, exact);
    if (const auto* within = run.plan.as<PaintWithin>())
      result.counts.tolerance.measured = brokenPart(result.picture.rgba, exact, within->tolerance);
    for (const auto& [name, seconds] : truth.stages.seconds()) journal_.stages.add("truth: " + name, seconds);
  }
  result.layers = veilLayers(request.layers, result.veil);
  result.layers.insert(result.layers.end(), run.lighting->shadows.layers.begin(), run.lighting->shadows.layers.end());
  if (asks(request.layers, LayerName::edges))
    result.layers.push_back(edgesLayer(gbuffer, run.plan.edges ? &edges() : nullptr));
  if (wantsPlanes(request.layers)) {
    RunCounts unused;
    const Plan sums = sumsPlanOf(run.plan, facts_);
    const PaintContext context{sums, *shot_, run.lighting->picture, *run.sources, device_, journal_, unused};
    const OitPlanes planes = journal_.time("debug planes", [&] { return sumsOf(context, run.pass); });
    result.layers.push_back(planeLayer(request.layers, planes));
  }
  for (const auto& file : shot_->deep) journal_.note(file->notes());
  result.stages = std::exchange(journal_.stages, Stages());
  result.device = device_.description();
  return result;
}

shading::WeightSettings Compositor::fitWeight(Request request) {
  request.sums.fitWeight = true;
  return prepare(request).plan.pass.weight;
}

RunCounts Compositor::accumulate(const Request& request, const std::function<void(PassPlanes&&)>& each) {
  if (shot_->deepOpaque) expectPlacesHold(request);
  const Run run = prepare(request);
  const GBuffer& gbuffer = *run.lighting->picture.gbuffer;
  const OtherSolids others(request.heldOutBy, gbuffer, shot_->opaque.space, run.plan.passes);
  RunCounts counts;
  Plan sums = sumsPlanOf(run.plan, facts_);
  sums.heldOut = run.plan.heldOut;
  const std::unique_ptr<EdgePasses> edges = edgePasses(run.plan);
  PassPicture moving(run.lighting->picture, depthPlanes(run.plan.passes), edges.get(), triangles(), shot_->camera);
  const GBuffer& moved = *moving.picture().gbuffer;
  bool shows = false;
  for (int i = 0; i < run.plan.passes; ++i) {
    PassSettings sample = samplePass(run.pass, run.plan, i);
    sample.weight = sums.fitsWeight ? run.pass.weight : sums.pass.weight;
    sample.normalisation = sums.pass.normalisation;
    moving.moveTo(sample.sample, i);
    PassPlanes made;
    if (others.empty()) {
      made = passPlanes(sums, sample, i, run, moving.picture(), request, counts);
    } else {
      const GBuffer held = others.before(moved, i);
      const GBuffer heldAtCentres = others.before(gbuffer, i);
      const DrawnOverPicture over(triangles(), held, moved, shot_->camera);
      made = passPlanes(sums, sample, i, run, {&held, &heldAtCentres, nullptr}, request, counts);
      others.addTo(made.planes, i);
    }
    made.planes.info.method = made.scatter.info.method = sums.method;
    made.planes.info.space = made.scatter.info.space = shot_->opaque.space;
    made.edges = run.plan.edges;
    made.pixelFilter = run.plan.pixelFilter;
    if (i == 0) made.relit = relitPicture(*run.lighting);
    shows = shows || anyLayers(made.planes);
    each(std::move(made));
  }
  if (!shows) noteThatNothingShows(*shot_, journal_);
  for (const auto& file : shot_->deep) journal_.note(file->notes());
  return counts;
}

PassPlanes Compositor::passPlanes(const Plan& sums, const PassSettings& sample, int pass, const Run& run,
                                  const LitPicture& picture, const Request& request, RunCounts& counts) {
  const PaintContext context{sums, *shot_, picture, *run.sources, device_, journal_, counts};
  PassPlanes made;
  if (sums.heldOut) {
    PlacedSums placed = journal_.time("lists and sums", [&] { return placedSumsOf(context, sample, pass); });
    made.planes = std::move(placed.places);
    made.scatter = std::move(placed.scatter);
    return made;
  }
  made.planes = journal_.time("transparent pass", [&] { return sumsOf(context, sample); });
  if (request.foliage.rule == FoliageRule::apart && triangles())
    made.rims = journal_.time("rims", [&] { return triangles()->rims(fullResolutionPart(sums, sample)); });
  if (!made.rims.empty()) ++counts.passes;
  return made;
}

RunCounts Compositor::listFragments(const Request& request, const ListSink& sink) {
  const Run run = prepare(request);
  RunCounts counts;
  journal_.time("lists and write", [&] {
    run.sources->each({run.pass, run.lighting->picture, VolumeRule::split}, [&](const FragmentLists& lists) {
      counts.fragments += lists.fragments.size();
      sink(lists);
    });
  });
  if (counts.fragments == 0) noteThatNothingShows(*shot_, journal_);
  for (const auto& file : shot_->deep) journal_.note(file->notes());
  return counts;
}

std::map<std::string, std::string> Compositor::attributes(const Result& result) const {
  std::map<std::string, std::string> attributes{{kMethodAttribute, result.plan.method},
                                                {kWeightAttribute, weightText(result.plan.pass.weight)}};
  const ColourSpace& space = shot_->opaque.space;
  if (!space.isRec709()) attributes["pellucid:workingSpace"] = space.name;
  return attributes;
}

std::vector<std::string> Compositor::write(const std::string& path, const Result& result) const {
  return writeOver(path, shot_->opaque, shot_->hasScene ? &shot_->camera : nullptr, result.picture, result.layers,
                   attributes(result));
}

}  // namespace pellucid
