#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/render.h"
#include "composite/cli/results.h"
#include "composite/cli/shot.h"
#include "composite/cli/verbs.h"
#include "composite/error.h"

namespace pellucid::cli {
namespace {

// Eight samples: on the shipped samples their error against 64 is below what a display shows, at half the cost of 16.
constexpr int kDefaultSamples = 8;

struct CompositeFlags {
  std::string opaque, output;
  std::vector<std::string> scenes, layers;
  ReadFlags read;
  SceneFlags scene;
  MethodFlags method;
  RunFlags run;
  int samples = kDefaultSamples;
  bool measure = false, selfModulation = false;
};

void composite(const CompositeFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages);
  const GBuffer& gbuffer = shot->opaque.gbuffer;
  RenderSettings settings;
  settings.samples = flags.samples;
  settings.sortedTruth = flags.method.isOver();
  settings.resolve.selfModulation = flags.selfModulation;
  settings.pass.surroundings = shot->surroundings;
  flags.scene.applyTo(settings.pass);
  flags.method.applyTo(settings.pass, shot->camera);

  auto context = stages.time("GL context", [&] { return std::make_unique<GlContext>(flags.scene.device); });
  auto pass = stages.time(
      "upload", [&] { return std::make_unique<TransparentPass>(*context, shot->scene, gbuffer, shot->camera); });
  RenderCounts counts;
  const Veil veil = renderVeil(*pass, settings, gbuffer, stages, counts);
  const Picture picture = stages.time("compose", [&] { return compose(veil, gbuffer); });

  nlohmann::json report;
  report["output"] = flags.output;
  report["method"] = flags.method.method;
  if (flags.measure) {
    RenderSettings truth = settings;
    truth.sortedTruth = true;
    RenderCounts truthCounts;
    Stages truthStages;
    const Veil truthVeil = renderVeil(*pass, truth, gbuffer, truthStages, truthCounts);
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
  say(stages.time("write", [&] {
    return writePicture(flags.output, shot->opaque, picture.rgba, picture.touched, requestedLayers(flags.layers, veil),
                 {{"pellucid:method", flags.method.method}});
  }));
  reportRun(flags.run, stages, counts, context->description(), report);
}

}  // namespace

void addComposite(CLI::App& app) {
  auto flags = std::make_shared<CompositeFlags>();
  CLI::App* verb = app.add_subcommand("composite", "Composite transparent geometry onto an opaque render");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("scenes", flags->scenes, "glTF or GLB with the transparent things")->required();
  verb->add_option("-o,--output", flags->output, "EXR to write")->required();
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->method.addTo(*verb, true);
  flags->run.addTo(*verb);
  verb->add_option("--aa", flags->samples, "Jittered passes, averaged; 1 samples pixel centres")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb->add_flag("--measure", flags->measure, "Also composite the sorted truth and print the error against it");
  verb->add_flag("--self-modulation", flags->selfModulation, "PT17 eq. 14, a heuristic for --normalisation published");
  addLayersOption(*verb, flags->layers);
  verb->callback([flags] { composite(*flags); });
}

}  // namespace pellucid::cli
