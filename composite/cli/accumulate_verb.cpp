#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/over_frames.h"
#include "composite/cli/render_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/compositor.h"
#include "gbuffer/planes_io.h"

namespace pellucid::cli {
namespace {

struct AccumulateFlags {
  std::string output;
  std::vector<std::string> heldOutBy;
  RenderFlags render;
  RunFlags run;
  SequenceFlags sequence;
};

void accumulate(const AccumulateFlags& flags, const FrameRun& frame, const std::shared_ptr<KeptWork>& kept) {
  const Threads threads(flags.run.threads);
  Request request = frame.weighed(flags.render.request());
  request.heldOutBy = flags.heldOutBy;
  Compositor compositor(
      request, [](const std::string& note) { say(note); }, frame.watcher(), kept);
  std::vector<PassPlanes> passes;
  const RunCounts counts =
      compositor.accumulate(request, [&](PassPlanes&& pass) { passes.push_back(std::move(pass)); });
  if (request.foliage.rule == FoliageRule::apart && passes[0].rims.empty())
    say("no cut-out leaf waits for its occlusion: the planes carry no rims");
  Stages& stages = compositor.journal().stages;
  stages.time("write", [&] { writePasses(flags.output, passes, frame.attributes); });
  nlohmann::json report{{"output", flags.output}};
  reportSpace(compositor.shot().opaque.space, report);
  reportRun(flags.run, stages, counts, compositor.device(), report);
}

}  // namespace

void addAccumulate(CLI::App& app) {
  auto flags = std::make_shared<AccumulateFlags>();
  CLI::App* verb = app.add_subcommand("accumulate", "The transparent pass alone: sums of the layers, for resolve");
  RenderVerb what;
  what.listsToo = false;
  what.resolves = false;
  what.keepsRimsApart = true;
  what.usual = UsualMethod::sums;
  flags->render.addTo(*verb, what);
  verb->add_option("--held-out-by", flags->heldOutBy,
                   "Planes whose solids hide what stands behind them here: so all of them add up in resolve")
      ->allow_extra_args(false);
  verb->add_option("-o,--output", flags->output, "EXR of planes to write")->required();
  flags->run.addTo(*verb);
  flags->sequence.addTo(*verb);
  verb->callback([verb, flags] {
    const auto kept = std::make_shared<KeptWork>(flags->render.scene.device);
    VerbRun run{flags->run.json, [&](const FrameRun& frame) { accumulate(*flags, frame, kept); }};
    run.fits = [&] { return fitsOwnWeight(flags->render.request()); };
    overFrames(*verb, flags->sequence, run);
  });
}

}  // namespace pellucid::cli
