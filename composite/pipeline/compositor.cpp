#include "composite/pipeline/compositor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "composite/antialias.h"
#include "composite/pipeline/cheapest.h"
#include "composite/pipeline/default_weight.h"
#include "composite/pipeline/drawn_probes.h"
#include "composite/pipeline/fit.h"
#include "composite/pipeline/foliage_step.h"
#include "composite/pipeline/held_out_planes.h"
#include "composite/pipeline/memory_picture.h"
#include "composite/pipeline/method_file.h"
#include "composite/pipeline/not_finite.h"
#include "composite/pipeline/nothing_drawn.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/pass_motion.h"
#include "composite/pipeline/pass_picture.h"
#include "composite/pipeline/refusals.h"
#include "composite/pipeline/sums.h"
#include "composite/pipeline/system_weights.h"
#include "composite/pipeline/weight_file.h"
#include "engine_bridge/scene/screen_bounds.h"
#include "gbuffer/errors.h"
#include "gbuffer/supersampled.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

// Requests of one light may share it.
bool sameLight(const Request& a, const Request& b) {
  return a.passes == b.passes && a.particleLight == b.particleLight && a.shadows == b.shadows && a.fog == b.fog;
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

// Shot and picture as a pass sees them.
void moveTo(int pass, PassSettings& sample, PassMotion& motion, PassPicture& picture, Journal& journal) {
  if (motion.moves()) journal.time("pose", [&] { motion.moveTo(pass, sample); });
  picture.moveTo(sample.sample, pass, motion.picture());
  motion.occlude(*picture.picture().gbuffer, sample);
}

// Shows the background and adds to the mean strip by strip, so that no second plane of what is shown is there.
void addPass(int pass, const Veil& veil, Painter& painter, const EdgePasses* edges, VeilMean& mean, Journal& journal) {
  constexpr int kRows = 64;
  mean.begin(veil);
  for (int y = 0; y < veil.touched.height(); y += kRows) {
    Veil rows = rowsOf(veil, y, std::min(y + kRows, veil.touched.height()));
    painter.showBackground(rows);
    journal.time("average", [&] {
      if (edges) edges->weigh(pass, rows);
      mean.addRows(rows);
    });
  }
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
  const Request* request = nullptr;
  Lens lens;
};

Compositor::Compositor(const Request& request, std::function<void(const std::string&)> sink,
                       std::function<void(const std::string&, double)> watch, std::shared_ptr<KeptWork> kept)
    : journal_(std::move(sink), std::move(watch)),
      kept_(kept ? std::move(kept) : std::make_shared<KeptWork>(request.device)),
      device_(kept_->device) {
  validate(request);
  validate(methodByFile(request));
  takeOver(request);
  facts_ = factsOf(*shot_);
}

void Compositor::takeOver(const Request& request) {
  try {
    shot_ = loadShot(request.shot, meetsRays(request), journal_, std::move(kept_->shot));
  } catch (...) {
    kept_->forget();
    throw;
  }
  if (shot_->keptPicture) {
    depth_ = std::move(kept_->depth);
  }
  if (shot_->keptScene) triangles_ = std::move(kept_->triangles);
  placed_ = !triangles_;
  kept_->forget();  // what is left is of another shot
}

Compositor::~Compositor() {
  const Device::Turn turn(device_);
  lighting_.reset();
  if (kept_.use_count() == 1 || !finished_ || shot_->inMemory) {
    triangles_.reset();
  } else {
    kept_->forget();
    kept_->shot = std::move(shot_);
    kept_->triangles = std::move(triangles_);
    kept_->depth = std::move(depth_);
  }
  if (kept_.use_count() == 1) device_.close();
}

Plan Compositor::plan(const Request& request) const {
  const Request taken = methodByFile(request);
  validate(taken);
  const Request weighed = weighedByFile(taken);
  if (asksDepths(weighed) && !knowsDepths_) {
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
  if (!std::exchange(placed_, true))
    journal_.time("upload", [&] {
      triangles_->pose(shot_->camera);
      triangles_->over(shot_->opaque.gbuffer, shot_->camera);
    });
  return triangles_.get();
}

const DepthPlanes* Compositor::depthPlanes(const Plan& plan, const Window& area) {
  if (plan.passes == 1 && !plan.pictureMoves && plan.lowResolution == 1) return nullptr;
  // Deep layers belong to whole pixels: they are held out by what lies at the pixel's centre.
  if (shot_->deepOpaque && (plan.pictureMoves || !shot_->deep.empty())) return nullptr;
  const DepthPlanes& planes = depth_.planes(shot_->opaque.gbuffer, shot_->camera, area, journal_);
  dropNormals(planes);
  return &planes;
}

// Nothing but the planes reads them.
void Compositor::dropNormals(const DepthPlanes& known) {
  GBuffer& gbuffer = shot_->opaque.gbuffer;
  if (!shot_->inMemory && known.part() == Window{0, 0, gbuffer.data.width(), gbuffer.data.height()})
    gbuffer.normal = Image<glm::vec3>();
}

std::unique_ptr<EdgePasses> Compositor::edgePasses(const Plan& plan, const Window& area) {
  if (!plan.edges) return nullptr;
  std::vector<glm::dvec2> samples;
  for (int i = 0; i < plan.passes; ++i) samples.push_back(samplePass(plan.pass, plan, i).sample);
  return std::make_unique<EdgePasses>(depth_.edges(shot_->opaque.gbuffer, shot_->camera, area, journal_),
                                      std::move(samples));
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
  expectWholePixels(request.shot.opaque, shot_->opaque.gbuffer, run.plan.supersampled);
  run.request = &request;
  if (run.plan.shutter && run.plan.shutter->opens() && !shot_->moment)
    throw MeaningError(
        fmt::format("{}: --shutter: found no frame in its header (Frame or timeCode), expected one, or --frame N or "
                    "--time SECONDS",
                    request.shot.opaque));
  journal_.note(run.plan.notes);
  run.lens = lensOf(request.lens, shot_->opaque.document, shot_->opaque.gbuffer, shot_->camera, journal_);
  run.lighting = &lightOf(request);
  run.pass = run.plan.pass;
  run.lighting->applyTo(run.pass, *shot_);
  TransparentPass* pass = triangles();
  run.sources = std::make_unique<LayerSources>(pass);
  if (!shot_->deep.empty()) run.sources->join(deepFiles(shot_->deep));
  if (run.lighting->fog) run.sources->join(fogRuns());
  if (pass) {
    // Leaves that the passes resolve are occluders, at whatever distance one sample a pixel would resolve them.
    PassSettings drawn = samplePass(run.pass, run.plan, 0);
    placeOccluders(request.foliage, drawn, *pass, *run.lighting->picture.gbuffer, shot_->camera, journal_);
    run.pass.occlusion = drawn.occlusion;
  }
  if (run.plan.fitsWeight) {
    RunCounts unused;
    const std::unique_ptr<EdgePasses> edges = edgePasses(run.plan, run.lighting->picture.gbuffer->data);
    PassPicture moving(run.lighting->picture, depthPlanes(run.plan, run.lighting->picture.gbuffer->data), edges.get(),
                       pass, shot_->camera, run.lighting->picture.gbuffer->data);
    const PaintContext context{run.plan, *shot_, moving.picture(), *run.sources, device_, journal_, unused};
    run.pass.weight = run.plan.pass.weight = fittedWeight(context, moving, run.pass);
  }
  const auto* systems = run.plan.as<PaintSystems>();
  if (systems && fitsAny(*systems)) {
    RunCounts unused;
    const std::unique_ptr<EdgePasses> edges = edgePasses(run.plan, run.lighting->picture.gbuffer->data);
    const PaintContext context{run.plan, *shot_, run.lighting->picture, *run.sources, device_, journal_, unused};
    run.plan.paint =
        fittedSystems(context, run.pass, depthPlanes(run.plan, run.lighting->picture.gbuffer->data), edges.get());
  }
  return run;
}

// All of the picture, but where triangles alone are painted pixel by pixel.
Window Compositor::paintedArea(const Plan& plan, const Run& run) const {
  const GBuffer& gbuffer = *run.lighting->picture.gbuffer;
  const bool byLists = plan.as<PaintSorted>() || plan.as<PaintListed>();
  const bool byPixels =
      byLists || (plan.as<PaintSums>() && !plan.isPublished() && !plan.resolvesOnDevice && plan.lowResolution == 1);
  const bool alone = run.sources->trianglesAlone() && !run.lighting->fog;
  if (!byPixels || !alone || plan.heldOut || shot_->deepOpaque) return gbuffer.data;
  Window area = screenBounds(shot_->scene, shot_->camera, gbuffer);
  // Places of a wide filter lie in other pixels, and a texel is told to pixels up to two texels away.
  const int reach =
      static_cast<int>(std::ceil(plan.pixelFilter.radius)) + (plan.lowResolution > 1 ? 2 * plan.lowResolution : 0);
  area.x0 = std::max(area.x0 - reach, gbuffer.data.x0);
  area.y0 = std::max(area.y0 - reach, gbuffer.data.y0);
  area.x1 = std::min(area.x1 + reach, gbuffer.data.x1);
  area.y1 = std::min(area.y1 + reach, gbuffer.data.y1);
  return area;
}

Veil Compositor::paint(const Plan& plan, const PassSettings& settings, const Run& run, Journal& journal,
                       RunCounts& counts, Image<float>* unseen) {
  PassMotion motion(*run.request, plan, run.lens, *shot_, triangles(), device_);
  PassSettings pass = settings;
  const Window& data = run.lighting->picture.gbuffer->data;
  const Window area = motion.moves() ? data : paintedArea(plan, run);
  // Bent rays may meet any of them.
  const std::unique_ptr<EdgePasses> edges = edgePasses(plan, run.sources->mayScatter(pass) ? data : area);
  if (area != data) pass.area = area;                          // else passes at other resolutions take the settings too
  const Window& known = plan.lowResolution > 1 ? data : area;  // texels anywhere ask for the surface at theirs
  PassPicture moving(run.lighting->picture, depthPlanes(plan, known), edges.get(), triangles(), shot_->camera, known);
  if (unseen) moving.countUnseen();
  const PaintContext context{plan, *shot_, moving.picture(), *run.sources, device_, journal, counts};
  const std::unique_ptr<Painter> painter = makePainter(context);
  VeilMean mean;
  do {
    mean = VeilMean();
    motion.begin();
    for (int i = 0; i < plan.passes; ++i) {
      PassSettings sample = samplePass(pass, plan, i);
      journal.reached(static_cast<double>(i) / plan.passes);
      moveTo(i, sample, motion, moving, journal);
      Veil veil = painter->paint(sample, i);
      if (painter->showsLater() && !motion.moves()) {
        addPass(i, veil, *painter, edges.get(), mean, journal);
        continue;
      }
      if (painter->showsLater()) painter->showBackground(veil);
      journal.time("average", [&] {
        if (edges) edges->weigh(i, veil);
        motion.relight(veil, *run.lighting->picture.gbuffer);
        mean.add(std::move(veil));
      });
    }
  } while (!painter->settled());
  if (unseen) *unseen = moving.unseenShare();
  journal.reached(1.0);
  return journal.time("average", [&] {
    Veil veil = mean.finish();
    if (edges) edges->finish(veil);
    motion.finish(veil);
    painter->finish(veil);
    return veil;
  });
}

Result Compositor::run(const Request& request) {
  const Device::Turn turn(device_);
  const Request taken = methodByFile(request);
  if (const auto* cheap = std::get_if<PaintCheapest>(&taken.paint)) return cheapest(taken, cheap->tolerance);
  return painted(taken, 0.0);
}

Choice Compositor::probed(const Run& run, double tolerance) {
  const std::unique_ptr<EdgePasses> edges = edgePasses(run.plan, run.lighting->picture.gbuffer->data);
  PassPicture moving(run.lighting->picture, depthPlanes(run.plan, run.lighting->picture.gbuffer->data), edges.get(),
                     triangles(), shot_->camera, run.lighting->picture.gbuffer->data);
  RunCounts unused;
  const PaintContext context{run.plan, *shot_, moving.picture(), *run.sources, device_, journal_, unused};
  return journal_.time("probe method", [&] {
    DrawnProbes probes(context, moving, run.pass);
    Choice choice;
    choice.tolerance = tolerance;
    choice.layers = probes.layers();
    choice.onProbes = probes.brokenPart(run.pass.weight, tolerance);
    return choice;
  });
}

Result Compositor::cheapest(const Request& request, double tolerance) {
  Request sums = bySums(request);
  const Run run = prepare(sums);
  Choice choice = probed(run, tolerance);
  Stages asked = std::exchange(journal_.stages, Stages());
  Result result;
  if (sumsMayDo(choice)) {
    setWeight(sums, run.plan.pass.weight);
    result = painted(sums, tolerance);
    choice.measured = result.counts.tolerance.measured;
  }
  if (!sumsDo(choice)) {
    for (const auto& [name, seconds] : result.stages.seconds()) asked.add("left: " + name, seconds);
    result = painted(byTruth(request), 0.0);
  }
  for (const auto& [name, seconds] : asked.seconds()) result.stages.add(name, seconds);
  result.choice = choice;
  result.plan.methodReason = reasonOf(choice);
  journal_.note("--method auto: " + reasonOf(choice));
  return result;
}

Result Compositor::painted(const Request& request, double holdTo) {
  finished_ = false;
  const Run run = prepare(request);
  Result result;
  result.plan = run.plan;
  Image<float> unseen;
  result.veil = paint(run.plan, run.pass, run, journal_, result.counts,
                      asks(request.layers, LayerName::unseen) ? &unseen : nullptr);
  const GBuffer& gbuffer = *run.lighting->picture.gbuffer;
  const int samples = run.plan.supersampled;
  result.dataWindow = pixelsOf(gbuffer.data, samples);
  result.picture = journal_.time("compose", [&] { return compose(result.veil, gbuffer); });
  noteWhatIsNotFinite(result.picture, result.veil, gbuffer, journal_);
  const Image<std::uint8_t>& shadowed = run.lighting->shadows.touched;
  for (std::size_t i = 0; i < shadowed.size(); ++i) result.picture.touched[i] |= shadowed[i];
  if (!anyTouched(result.veil.touched) && !anyTouched(result.picture.touched)) noteThatNothingShows(*shot_, journal_);
  if (samples > 1) result.picture = {meansOf(result.picture.rgba, samples), anyOf(result.picture.touched, samples)};
  if (request.measure || holdTo > 0.0) {
    Journal truth = journal_.beside();
    RunCounts unused;
    Image<glm::vec4> exact = compose(paint(truthOf(run.plan), run.pass, run, truth, unused), gbuffer).rgba;
    if (samples > 1) exact = meansOf(exact, samples);
    if (request.measure) result.error = measureError(result.picture.rgba, exact);
    const auto* within = run.plan.as<PaintWithin>();
    if (const double tolerance = within ? within->tolerance : holdTo; tolerance > 0.0)
      result.counts.tolerance.measured = brokenPart(result.picture.rgba, exact, tolerance);
    for (const auto& [name, seconds] : truth.stages.seconds()) journal_.stages.add("truth: " + name, seconds);
  }
  if (!request.layers.empty()) result.veil = widened(std::move(result.veil), gbuffer.data);
  result.layers = veilLayers(request.layers, result.veil);
  if (!run.lighting->shadows.layer.empty()) result.layers.push_back(shadowLayer(run.lighting->shadows.layer));
  if (!unseen.empty()) result.layers.push_back(unseenLayer(std::move(unseen)));
  if (asks(request.layers, LayerName::edges))
    result.layers.push_back(
        edgesLayer(gbuffer, run.plan.edges ? &depth_.edges(shot_->opaque.gbuffer, shot_->camera, gbuffer.data, journal_)
                                           : nullptr));
  if (wantsPlanes(request.layers)) {
    RunCounts unused;
    const Plan sums = sumsPlanOf(run.plan, facts_);
    const PaintContext context{sums, *shot_, run.lighting->picture, *run.sources, device_, journal_, unused};
    const OitPlanes planes = journal_.time("debug planes", [&] { return sumsOf(context, run.pass); });
    result.layers.push_back(planeLayer(request.layers, planes));
  }
  if (samples > 1)
    for (ExtraLayer& layer : result.layers) layer = pixelsOf(layer, samples);
  for (const auto& file : shot_->deep) journal_.note(file->notes());
  result.stages = std::exchange(journal_.stages, Stages());
  result.device = device_.description();
  finished_ = true;
  return result;
}

shading::WeightSettings Compositor::fitWeight(Request request) {
  const Device::Turn turn(device_);
  request.sums.fitWeight = true;
  return prepare(request).plan.pass.weight;
}

RunCounts Compositor::accumulate(const Request& asked, const std::function<void(PassPlanes&&)>& each) {
  const Request request = paintsBy<PaintSorted>(asked) ? bySums(asked) : asked;
  if (shot_->deepOpaque) expectPlacesHold(request);
  const Device::Turn turn(device_);
  finished_ = false;
  const Run run = prepare(request);
  const GBuffer& gbuffer = *run.lighting->picture.gbuffer;
  const OtherSolids others(request.heldOutBy, gbuffer, shot_->opaque.space, run.plan.passes);
  RunCounts counts;
  Plan sums = sumsPlanOf(run.plan, facts_);
  sums.heldOut = run.plan.heldOut;
  const std::unique_ptr<EdgePasses> edges = edgePasses(run.plan, run.lighting->picture.gbuffer->data);
  const Camera taken = shot_->camera;
  PassMotion motion(request, run.plan, run.lens, *shot_, triangles(), device_);
  PassPicture moving(run.lighting->picture, depthPlanes(run.plan, run.lighting->picture.gbuffer->data), edges.get(),
                     triangles(), shot_->camera, gbuffer.data);
  bool shows = false;
  for (int i = 0; i < run.plan.passes; ++i) {
    PassSettings sample = samplePass(run.pass, run.plan, i);
    journal_.reached(static_cast<double>(i) / run.plan.passes);
    sample.weight = sums.fitsWeight ? run.pass.weight : sums.pass.weight;
    sample.normalisation = sums.pass.normalisation;
    moveTo(i, sample, motion, moving, journal_);
    PassPlanes made;
    if (others.empty()) {
      made = passPlanes(sums, sample, i, run, moving.picture(), request, counts);
    } else {
      const GBuffer& moved = *moving.picture().gbuffer;
      const GBuffer held = others.before(moved, i);
      const GBuffer heldAtCentres = others.before(*moving.picture().centres, i);
      const DrawnOverPicture over(triangles(), held, moved, shot_->camera);
      made = passPlanes(sums, sample, i, run, {&held, &heldAtCentres, nullptr}, request, counts);
      others.addTo(made.planes, i);
    }
    made.planes.info.method = made.scatter.info.method = sums.method;
    made.planes.info.space = made.scatter.info.space = shot_->opaque.space;
    made.edges = run.plan.edges;
    made.pixelFilter = run.plan.pixelFilter;
    if (i == 0) made.relit = relitPicture(*run.lighting);
    if (i == 0 && !run.plan.heldOut) made.shadow = run.lighting->shadows.layer;
    if (i == 0 && motion.moves()) made.pictureCamera = taken;
    if (motion.picture() && motion.picture()->gbuffer != &gbuffer) made.now = motion.picture()->gbuffer->beauty;
    shows = shows || anyLayers(made.planes);
    each(std::move(made));
  }
  if (!shows) noteThatNothingShows(*shot_, journal_);
  if (run.plan.heldOut && !run.lighting->shadows.layer.empty())
    journal_.note("the layer `shadow` is left out: planes over a deep picture hold its samples, not its pixels");
  for (const auto& file : shot_->deep) journal_.note(file->notes());
  finished_ = true;
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
  const Device::Turn turn(device_);
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
  std::map<std::string, std::string> attributes = methodAttributes(result.plan);
  if (!shot_->opaque.space.isRec709()) attributes["pellucid:workingSpace"] = shot_->opaque.space.name;
  return attributes;
}

std::vector<std::string> Compositor::write(const std::string& path, const Result& result,
                                           const std::map<std::string, std::string>& beside) const {
  std::map<std::string, std::string> header = attributes(result);
  header.insert(beside.begin(), beside.end());
  const int n = result.plan.supersampled;
  if (shot_->inMemory)
    return writeFromMemory(path, shot_->opaque, shot_->hasCamera ? &shot_->camera : nullptr, result.picture.rgba,
                           result.layers, header, n);
  if (n > 1) return writePixels(path, shot_->opaque, n, result.picture.rgba, result.layers, header);
  return writeOver(path, shot_->opaque, shot_->hasScene ? &shot_->camera : nullptr, result.picture, result.layers,
                   header);
}

}  // namespace pellucid
