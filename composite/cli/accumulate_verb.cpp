#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "composite/cli/fog_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/mixed.h"
#include "composite/cli/render.h"
#include "composite/cli/results.h"
#include "composite/cli/scatter_flags.h"
#include "composite/cli/shot.h"
#include "composite/cli/verbs.h"
#include "composite/fog.h"
#include "composite/fold_exact.h"
#include "engine_bridge/gl/solid_hash.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"

namespace pellucid::cli {
namespace {

struct AccumulateFlags {
  std::string opaque, output;
  std::vector<std::string> scenes;
  ReadFlags read;
  SceneFlags scene;
  MethodFlags method;
  ScatterFlags scatter;
  FoliageFlags foliage;
  FogFlags fog;
  ParticleFlags particles;
  LowResFlags lowRes;
  RunFlags run;
};

// The `exact` tier: fragment lists, folded in an order of their own.
OitPlanes exactPlanes(TransparentPass& pass, const PassSettings& settings, const Shot& shot) {
  OitPlanes planes = emptyPlanes(shot.opaque.gbuffer.display, shot.opaque.gbuffer.data);
  planes.camera = shot.camera;
  planes.info.weight = settings.weight;
  planes.info.normalisation = settings.normalisation;
  planes.info.tier = "exact";
  pass.fragments(settings,
                 [&](const FragmentLists& tile) { foldExact(tile, settings.weight, settings.normalisation, planes); });
  if (settings.fog) addFog(*settings.fog, shot.opaque.gbuffer, settings.sample, planes);
  planes.info.solidHash = gl::solidHash(planes.solid);
  return planes;
}

void accumulate(const AccumulateFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages);
  if (!shot->deep.empty())
    throw UsageError(fmt::format("{}: accumulate takes glTF only: found deep samples, which composite takes",
                                 shot->deep[0]->path()));
  if (shot->deepOpaque)
    throw UsageError(
        fmt::format("{}: accumulate takes a flat picture: found deep samples, which composite takes", flags.opaque));
  PassSettings settings;
  settings.surroundings = shot->surroundings;
  settings.environment = shot->environment;
  flags.scene.applyTo(settings);
  flags.method.applyTo(settings, shot->camera);
  flags.scatter.applyTo(settings);
  Air air(*shot, nullptr, flags.scenes, flags.scene.options(flags.read.unit, true));
  settings.fog =
      flags.fog.place(*shot, air, flags.read.unit, flags.method.isPublished() ? "--precision published" : "", stages);
  settings.particleLight = flags.particles.place(*shot, air, stages);
  if (flags.foliage.isApart() && flags.method.precision != "float")
    throw UsageError(
        fmt::format("--occlusion: found apart with --precision {}, expected float: rims are summed in floats",
                    flags.method.precision));
  GlContext context(flags.scene.device);
  TransparentPass pass(context, shot->scene, shot->opaque.gbuffer, shot->camera);
  flags.foliage.applyTo(settings, &pass, shot->opaque.gbuffer, shot->camera, stages);
  const int factor = flags.lowRes.factorFor(
      shot->scene, flags.method.precision != "float" ? "--precision " + flags.method.precision : "");
  PassStatistics statistics;
  const OitPlanes planes = stages.time("transparent pass", [&] {
    if (!flags.method.isExact())
      return accumulateMixed(pass, settings, shot->opaque.gbuffer, shot->camera, factor, statistics);
    OitPlanes exact = exactPlanes(pass, settings, *shot);
    statistics = pass.statistics();
    return exact;
  });
  RimPlanes rims;
  if (flags.foliage.isApart()) {
    if (factor > 1) settings.layers = LayerChoice::fullResolution;
    rims = stages.time("rims", [&] { return pass.rims(settings); });
    if (rims.empty()) spdlog::info("no cut-out leaf waits for its occlusion: the planes carry no rims");
    if (!rims.empty()) ++statistics.passes;
  }
  stages.time("write", [&] { writePlanes(flags.output, planes, rims); });
  nlohmann::json report{{"output", flags.output}};
  RenderCounts counts;
  addStatistics(statistics, counts);
  reportRun(flags.run, stages, counts, context.description(), report);
}

}  // namespace

void addAccumulate(CLI::App& app) {
  auto flags = std::make_shared<AccumulateFlags>();
  CLI::App* verb = app.add_subcommand("accumulate", "The transparent pass alone: sums of the layers at pixel centres");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("scenes", flags->scenes, "glTF or GLB with the transparent things")->required();
  verb->add_option("-o,--output", flags->output, "EXR of planes to write")->required();
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->method.addTo(*verb, false);
  flags->scatter.addTo(*verb);
  flags->foliage.addTo(*verb, true);
  flags->fog.addTo(*verb);
  flags->particles.addTo(*verb);
  flags->lowRes.addTo(*verb);
  flags->run.addTo(*verb);
  verb->callback([flags] { accumulate(*flags); });
}

}  // namespace pellucid::cli
