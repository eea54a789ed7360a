#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/results.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/output_layers.h"

namespace pellucid::cli {
namespace {

void resolveVerb(const ResolveFlags& flags) {
  const Threads threads(flags.run.threads);
  const ColourRequest colour = flags.colour.request();
  flags.preview.check(colour, flags.colour.assetRoot, true);
  Journal notes = journal();
  const ResolvedPlanes result = resolvePlanes(flags.request(), notes);
  say(notes.time("write", [&] {
    return writeOver(flags.output, result.opaque, &result.camera, result.picture, result.layers,
                     {{"pellucid:method", result.info.method}});
  }));
  nlohmann::json report{{"output", flags.output}};
  reportSpace(result.opaque.space, report);
  flags.preview.write(colour, flags.colour.assetRoot, result.opaque.space, result.picture.rgba);
  reportRun(flags.run, notes.stages, {}, result.device, report);
}

}  // namespace

void ResolveFlags::addTo(CLI::App& verb) {
  verb.add_option("opaque", opaque, "EXR with beauty and depth")->required();
  verb.add_option("planes", planes, "EXR of planes; several are added")->required();
  verb.add_option("-o,--output", output, "EXR to write")->required();
  read.addTo(verb);
  run.addTo(verb);
  lookup.addTo(verb);
  selfModulation.addTo(verb);
  lookup.addResolverTo(verb);
  rims.addTo(verb);
  addLayersOption(verb, layers);
  preview.addTo(verb);
  colour.addConfigTo(verb);
}

PlanesRequest ResolveFlags::request() const {
  PlanesRequest request;
  request.opaque = opaque;
  request.read = read.options();
  request.planes = planes;
  request.selfModulation = selfModulation.value();
  request.lookup = lookup.settings();
  request.onDevice = lookup.onDevice();
  request.rims = rims.request();
  request.layers = layerNames(layers);
  return request;
}

void addResolve(CLI::App& app) {
  auto flags = std::make_shared<ResolveFlags>();
  CLI::App* verb = app.add_subcommand("resolve", "The compositing step alone: planes over an opaque render");
  flags->addTo(*verb);
  verb->callback([flags] { resolveVerb(*flags); });
}

}  // namespace pellucid::cli
