#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/colour_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/preview_flags.h"
#include "composite/cli/render_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/output_layers.h"
#include "composite/pipeline/resolve_planes.h"

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
  ColourFlags colour;
  PreviewFlags preview;
  SequenceFlags sequence;
};

PlanesRequest requestOf(const ResolveFlags& flags) {
  PlanesRequest request;
  request.opaque = flags.opaque;
  request.read = flags.read.options();
  request.planes = flags.planes;
  request.selfModulation = flags.selfModulation.value();
  request.lookup = flags.lookup.settings();
  request.onDevice = flags.lookup.onDevice();
  request.rims = flags.rims.request();
  request.layers = layerNames(flags.layers);
  return request;
}

void resolveVerb(const ResolveFlags& flags, const FrameRun& frame) {
  const Threads threads(flags.run.threads);
  const ColourRequest colour = flags.colour.request();
  flags.preview.check(colour, true);
  Journal notes([](const std::string& sentence) { say(sentence); }, frame.watcher());
  const ResolvedPlanes result = resolvePlanes(requestOf(flags), notes);
  flags.preview.write(colour, result.opaque.space, result.picture.rgba);
  say(notes.time("write", [&] {
    return writeOver(flags.output, result.opaque, &result.camera, result.picture, result.layers,
                     frame.with({{"pellucid:method", result.info.method}}));
  }));
  nlohmann::json report{{"output", flags.output}};
  reportSpace(result.opaque.space, report);
  reportRun(flags.run, notes.stages, {}, result.device, report);
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
  flags->preview.addTo(*verb);
  flags->colour.addConfigTo(*verb);
  flags->sequence.addTo(*verb);
  verb->callback([verb, flags] {
    overFrames(*verb, flags->sequence, {flags->run.json, [&](const FrameRun& frame) { resolveVerb(*flags, frame); }});
  });
}

}  // namespace pellucid::cli
