#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/fog_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/render.h"
#include "composite/cli/results.h"
#include "composite/cli/scatter_flags.h"
#include "composite/cli/shadow_flags.h"
#include "composite/cli/shot.h"
#include "composite/cli/stochastic_flags.h"
#include "composite/cli/systems.h"
#include "composite/cli/verbs.h"
#include "composite/error.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

// Of the sample `bottles`, 99.7% of the pixels lie within .02 of 64 samples; 16 bring that to 99.9% at twice the time.
constexpr int kDefaultSamples = 8;

struct CompositeFlags {
  std::string opaque, output;
  std::vector<std::string> scenes, layers;
  std::string systems = "off";
  ReadFlags read;
  SceneFlags scene;
  MethodFlags method;
  ScatterFlags scatter;
  LookupFlags lookup;
  FoliageFlags foliage;
  LowResFlags lowRes;
  RunFlags run;
  ShadowFlags shadow;
  FogFlags fog;
  ParticleFlags particles;
  StochasticFlags stochastic;
  int samples = kDefaultSamples;
  std::optional<double> tolerance;
  bool measure = false;
  SelfModulationFlag selfModulation;
};

void composite(const CompositeFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  flags.shadow.check();
  RenderSettings settings;
  const std::optional<ChosenMethod> chosen = flags.method.listMethod();
  settings.stochastic = flags.stochastic.settings(flags.method.method, flags.samples, flags.shadow.mapped());
  settings.lookup = flags.lookup.settings();
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages, flags.shadow.exact());
  const GBuffer& gbuffer = shot->opaque.gbuffer;
  if (flags.tolerance && flags.method.method != "phenomenological" && flags.method.method != "weighted")
    throw UsageError(
        fmt::format("--tolerance: --method {} has no certificate, expected weighted", flags.method.method));
  if (flags.tolerance && (flags.method.normalisation != "spectral" || flags.method.isPublished()))
    throw UsageError("--tolerance: the published normalisation has no certificate, expected spectral");
  if (flags.systems != "off" && (flags.tolerance || flags.method.isOver() || flags.method.precision != "float" ||
                                 shot->deepOpaque || !shot->deep.empty() || !shot->hasScene))
    throw UsageError(
        "--systems: expected glTF alone on a flat picture, by a blended method in float: the truth, a tolerance and "
        "deep "
        "files have no use for passes per system");
  if (settings.stochastic && (shot->deepOpaque || flags.systems != "off"))
    throw UsageError("--method stochastic: found a deep picture or --systems, expected a flat picture and one pass");
  settings.samples = flags.samples;
  settings.sortedTruth = flags.method.isOver();
  settings.tolerance = flags.tolerance;
  settings.exactSums = flags.method.isExact();
  settings.deepOpaque = shot->deepOpaque.get();
  settings.resolve.selfModulation = flags.selfModulation.isOn(flags.method.isPublished());
  if (flags.method.isPublished()) refusePublishedLayers(flags.layers);
  settings.pass.surroundings = shot->surroundings;
  settings.pass.environment = shot->environment;
  flags.scene.applyTo(settings.pass);
  flags.method.applyTo(settings.pass, shot->camera);
  useMethod(chosen, settings);
  flags.scatter.applyTo(settings.pass);

  // What works from lists of every fragment has no low resolution.
  const std::string listed = settings.sortedTruth || settings.listMethod || settings.stochastic
                                 ? "--method " + flags.method.method
                             : settings.tolerance                      ? "--tolerance"
                             : flags.method.precision != "float"       ? "--precision " + flags.method.precision
                             : flags.systems != "off"                  ? "--systems"
                             : !shot->deep.empty() || shot->deepOpaque ? "deep EXR"
                                                                       : "";
  settings.lowResolution = flags.lowRes.factorFor(shot->scene, listed);
  std::unique_ptr<GlContext> context;
  const auto device = [&]() -> GlContext& {
    if (!context) stages.time("GL context", [&] { context = std::make_unique<GlContext>(flags.scene.device); });
    return *context;
  };
  const ShadowResult shadows = stages.time("shadows", [&] {
    return castShadows(flags.shadow, *shot, flags.samples, static_cast<std::uint32_t>(flags.stochastic.seed), device);
  });
  {
    Air air(*shot, shadows.maps, flags.scenes, flags.scene.options(flags.read.unit, true));
    settings.pass.fog = flags.fog.place(*shot, air, flags.read.unit,
                                        flags.method.isPublished() ? "--precision published"
                                        : flags.systems != "off"   ? "--systems"
                                                                   : "",
                                        stages);
    settings.pass.particleLight = flags.particles.place(*shot, air, stages);
  }

  settings.pass.shadows = shadows.maps;
  settings.pass.shadowRays = stages.time("shadows", [&] { return surfaceLight(shadows, *shot); });

  std::unique_ptr<TransparentPass> pass;
  if (shot->hasScene) {
    device();
    stages.time("upload",
                [&] { pass = std::make_unique<TransparentPass>(*context, shot->scene, gbuffer, shot->camera); });
  }
  std::optional<StochasticPass> sampler;
  if (settings.stochastic && flags.stochastic.onDevice()) {
    if (!shot->hasScene || !shot->deep.empty())
      throw UsageError("--sampled-on: found gl with deep EXR, expected cpu: its samples are no triangles");
    if (settings.pass.fog) throw UsageError("--sampled-on: found gl with --fog, expected cpu: fog is no triangle");
    settings.sampler = &sampler.emplace(device(), shot->scene, gbuffer, shot->camera);
  }
  std::vector<SystemPass> systems;
  if (flags.systems != "off") {
    systems = stages.time("split systems", [&] { return splitSystems(flags.systems, flags.scenes, *shot, *context); });
    settings.systems = &systems;
    for (const SystemPass& system : systems) spdlog::info("system {}: at {:.4g} m", system.name, system.z);
  }
  std::optional<ResolvePass> resolver;
  if (flags.lookup.onDevice()) {
    if (settings.sortedTruth || settings.listMethod || settings.stochastic || settings.tolerance ||
        flags.method.isPublished() || shot->deepOpaque || flags.systems != "off")
      throw UsageError(fmt::format("--resolve: found gl with {}, expected cpu: it has no sums to resolve", listed));
    settings.device = &resolver.emplace(device());
  }
  flags.foliage.applyTo(settings.pass, pass.get(), gbuffer, shot->camera, stages);
  if (flags.method.isAuto()) fitShotWeight(pass.get(), shot->deep, gbuffer, settings.pass, stages);
  RenderCounts counts;
  const Veil veil = renderVeil(pass.get(), shot->deep, settings, gbuffer, shot->camera, stages, counts);
  if (counts.shadowRays)
    spdlog::info("light on transparent things: {} shadow rays in {:.2f} s", counts.shadowRays, counts.shadowSeconds);
  Picture picture = stages.time("compose", [&] { return compose(veil, gbuffer); });
  for (std::size_t i = 0; i < shadows.touched.size(); ++i) picture.touched[i] |= shadows.touched[i];

  nlohmann::json report;
  if (flags.tolerance) {
    report["tolerance"] = {{"E", *flags.tolerance},
                           {"certified", counts.tolerance.certified},
                           {"recomputed", counts.tolerance.recomputed}};
    if (!flags.run.json)
      fmt::print("tolerance {}: {} pixels certified, {} recomputed exactly\n", *flags.tolerance,
                 counts.tolerance.certified, counts.tolerance.recomputed);
  }
  report["output"] = flags.output;
  report["method"] = flags.method.method;
  if (flags.measure) {
    RenderSettings truth = settings;
    truth.sortedTruth = true;
    truth.listMethod.reset();
    truth.tolerance.reset();
    truth.systems = nullptr;
    truth.sampler = nullptr;
    truth.device = nullptr;
    RenderCounts truthCounts;
    Stages truthStages;
    const Veil truthVeil = renderVeil(pass.get(), shot->deep, truth, gbuffer, shot->camera, truthStages, truthCounts);
    const ErrorStatistics error = measureError(picture.rgba, compose(truthVeil, gbuffer).rgba);
    for (const auto& [name, seconds] : truthStages.seconds()) stages.add("truth: " + name, seconds);
    report["error"] = {{"mean", error.mean},
                       {"rmse", error.rmse},
                       {"p99", error.p99},
                       {"max", error.maximum},
                       {"worst", {error.worstX + gbuffer.data.x0, error.worstY + gbuffer.data.y0}},
                       {"pixels", error.pixels},
                       {"notFinite", error.nonFinite}};
    if (!flags.run.json) fmt::print("error of {} against sorted over: {}\n", flags.method.method, errorLine(error));
  }
  std::vector<ExtraLayer> layers = requestedLayers(flags.layers, veil);
  layers.insert(layers.end(), shadows.layers.begin(), shadows.layers.end());
  if (wantsDebugLayers(flags.layers)) {
    if (!pass)
      throw UsageError("--layers: D, delta, weight and count show the transparent pass: found deep files alone");
    PassStatistics statistics;
    const OitPlanes planes = stages.time("debug planes", [&] {
      return accumulateMixed(*pass, settings.pass, gbuffer, shot->camera, settings.lowResolution, statistics);
    });
    for (ExtraLayer& layer : debugLayers(flags.layers, planes)) layers.push_back(std::move(layer));
  }
  const std::map<std::string, std::string> attributes{{"pellucid:method", flags.method.method},
                                                      {"pellucid:weight", weightText(settings.pass.weight)}};
  say(stages.time("write", [&] {
    if (!shot->deepOpaque)
      return writePicture(flags.output, shot->opaque, picture.rgba, picture.touched, layers, attributes);
    layers.insert(layers.begin(), beautyLayer(picture.rgba));
    return writeLayers(flags.output, gbuffer.display, gbuffer.data, layers, attributes,
                       shot->hasScene ? &shot->camera : nullptr);
  }));
  for (const auto& source : shot->deep) say(source->notes());
  reportRun(flags.run, stages, counts, context ? context->description() : "CPU", report);
}

}  // namespace

void addComposite(CLI::App& app) {
  auto flags = std::make_shared<CompositeFlags>();
  CLI::App* verb = app.add_subcommand("composite", "Composite transparent geometry onto an opaque render");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("scenes", flags->scenes, "glTF, GLB or deep EXR with the transparent things")->required();
  verb->add_option("-o,--output", flags->output, "EXR to write")->required();
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->method.addTo(*verb, true);
  flags->scatter.addTo(*verb);
  flags->lookup.addTo(*verb);
  flags->foliage.addTo(*verb);
  flags->shadow.addTo(*verb);
  flags->fog.addTo(*verb);
  flags->particles.addTo(*verb);
  flags->stochastic.addTo(*verb);
  flags->lookup.addResolverTo(*verb);
  flags->lowRes.addTo(*verb);
  flags->run.addTo(*verb);
  verb->add_option("--aa", flags->samples, "Jittered passes, averaged; 1 samples pixel centres")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb->add_flag("--measure", flags->measure, "Also composite the sorted truth and print the error against it");
  verb->add_option("--tolerance", flags->tolerance,
                   "Error to live with, guaranteed for every pixel and channel: E times the larger of 1 and the value")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--systems", flags->systems, "A pass of its own for every input file or named node, sorted coarsely")
      ->check(CLI::IsMember({"off", "file", "node"}))
      ->capture_default_str();
  flags->selfModulation.addTo(*verb);
  addLayersOption(*verb, flags->layers);
  verb->callback([flags] { composite(*flags); });
}

}  // namespace pellucid::cli
