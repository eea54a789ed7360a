#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "composite/cli/device_resolve.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/scatter_flags.h"
#include "composite/cli/shot.h"
#include "composite/cli/verbs.h"
#include "composite/resolve.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"

namespace pellucid::cli {
namespace {

struct ResolveFlags {
  std::string opaque, output;
  std::vector<std::string> planes, layers;
  ReadFlags read;
  RunFlags run;
  LookupFlags lookup;
  SelfModulationFlag selfModulation;
  RimFlags rims;
};

std::string windowText(const Window& window) {
  return fmt::format("({}, {})-({}, {})", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

void resolveVerb(const ResolveFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const OpaqueFile opaque = stages.time("read picture", [&] { return readOpaque(flags.opaque, flags.read.options()); });
  say(opaque.notes);
  RimPlanes rims;
  OitPlanes planes = stages.time("read planes", [&] { return readPlanes(flags.planes[0], &rims); });
  for (std::size_t i = 1; i < flags.planes.size(); ++i)
    stages.time("read planes", [&] {
      RimPlanes more;
      mergePlanes(planes, readPlanes(flags.planes[i], &more));
      rims.add(more);
    });
  if (planes.data != opaque.gbuffer.data)
    throw MeaningError(fmt::format("{}: found data window {}, expected {} of {}", flags.planes[0],
                                   windowText(planes.data), windowText(opaque.gbuffer.data), flags.opaque));
  stages.time("occlusion of leaves", [&] { flags.rims.applyTo(rims, opaque.gbuffer, planes); });
  ResolveSettings settings;
  settings.selfModulation = flags.selfModulation.isOn(planes.published());
  if (planes.published()) refusePublishedLayers(flags.layers);
  const LookupSettings lookup = flags.lookup.settings();
  std::optional<GlContext> context;
  std::optional<ResolvePass> device;
  if (flags.lookup.onDevice() && planes.published())
    throw UsageError("--resolve: found gl with planes of tier published, expected cpu");
  if (flags.lookup.onDevice()) device.emplace(context.emplace());
  const Veil veil = stages.time(
      "resolve", [&] { return resolveSums(device ? &*device : nullptr, planes, settings, lookup, opaque.gbuffer); });
  const Picture picture = stages.time("compose", [&] { return compose(veil, opaque.gbuffer); });
  std::vector<ExtraLayer> layers = requestedLayers(flags.layers, veil);
  if (wantsDebugLayers(flags.layers))
    for (ExtraLayer& layer : debugLayers(flags.layers, planes)) layers.push_back(std::move(layer));
  say(stages.time("write", [&] {
    return writePicture(flags.output, opaque, picture.rgba, picture.touched, layers,
                        {{"pellucid:method", planes.info.method}});
  }));
  nlohmann::json report{{"output", flags.output}};
  reportRun(flags.run, stages, {}, context ? context->description() : "CPU", report);
}

}  // namespace

void addResolve(CLI::App& app) {
  auto flags = std::make_shared<ResolveFlags>();
  CLI::App* verb = app.add_subcommand("resolve", "The compositing step alone: planes over an opaque render");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("planes", flags->planes, "EXR of planes; several are added")->required();
  verb->add_option("-o,--output", flags->output, "EXR to write")->required();
  flags->read.addTo(*verb);
  flags->run.addTo(*verb);
  flags->lookup.addTo(*verb);
  flags->selfModulation.addTo(*verb);
  flags->lookup.addResolverTo(*verb);
  flags->rims.addTo(*verb);
  addLayersOption(*verb, flags->layers);
  verb->callback([flags] { resolveVerb(*flags); });
}

}  // namespace pellucid::cli
