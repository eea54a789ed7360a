#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verb_flags.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/compositor.h"
#include "composite/pipeline/default_weight.h"
#include "gbuffer/planes_io.h"

namespace pellucid::cli {
namespace {

void accumulate(const AccumulateFlags& flags, const FrameRun& frame, const std::shared_ptr<KeptWork>& kept) {
  const Threads threads(flags.run.threads);
  const Request request = frame.weighed(flags.request());
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

void AccumulateFlags::addTo(CLI::App& verb) {
  RenderVerb what;
  what.listsToo = false;
  what.blurs = true;
  what.resolves = false;
  what.keepsRimsApart = true;
  what.usual = UsualMethod::sums;
  render.addTo(verb, what);
  verb.add_option("--held-out-by", heldOutBy,
                  "Planes whose solids hide what stands behind them here: so all of them add up in resolve")
      ->allow_extra_args(false);
  verb.add_option("-o,--output", output, "EXR of planes to write")->required();
  run.addTo(verb);
}

Request AccumulateFlags::request() const {
  Request request = render.request();
  request.heldOutBy = heldOutBy;
  return request;
}

void addAccumulate(CLI::App& app) {
  auto flags = std::make_shared<AccumulateFlags>();
  auto sequence = std::make_shared<SequenceFlags>();
  CLI::App* verb = app.add_subcommand("accumulate", "The transparent pass alone: sums of the layers, for resolve");
  flags->addTo(*verb);
  sequence->addTo(*verb);
  verb->callback([verb, flags, sequence] {
    const auto kept = std::make_shared<KeptWork>(flags->render.scene.device);
    VerbRun run{flags->run.json, [&](const FrameRun& frame) { accumulate(*flags, frame, kept); }};
    run.fits = [&] { return fitsWeight(flags->request()); };
    overFrames(*verb, *sequence, run);
  });
}

}  // namespace pellucid::cli
