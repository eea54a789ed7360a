#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/output_layers.h"

namespace pellucid::cli {
namespace {

void resolveVerb(const ResolveFlags& flags, const FrameRun& frame) {
  const Threads threads(flags.run.threads);
  const ColourRequest colour = flags.colour.request();
  flags.preview.check(colour, flags.colour.assetRoot, true);
  Journal notes([](const std::string& sentence) { say(sentence); }, frame.watcher());
  const ResolvedPlanes result = resolvePlanes(flags.request(), notes);
  flags.preview.write(colour, flags.colour.assetRoot, result.opaque.space, result.picture.rgba);
  say(notes.time("write", [&] {
    return writeOver(flags.output, result.opaque, &result.camera, result.picture, result.layers,
                     frame.with({{"pellucid:method", result.info.method}}));
  }));
  nlohmann::json report{{"output", flags.output}};
  reportSpace(result.opaque.space, report);
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
  auto sequence = std::make_shared<SequenceFlags>();
  CLI::App* verb = app.add_subcommand("resolve", "The compositing step alone: planes over an opaque render");
  flags->addTo(*verb);
  sequence->addTo(*verb);
  verb->callback([verb, flags, sequence] {
    overFrames(*verb, *sequence, {flags->run.json, [&](const FrameRun& frame) { resolveVerb(*flags, frame); }});
  });
}

}  // namespace pellucid::cli
