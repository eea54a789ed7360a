#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/over_frames.h"
#include "composite/cli/render_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/row_gatherer.h"
#include "composite/cli/verbs.h"
#include "composite/deep/sample_channels.h"
#include "composite/pipeline/compositor.h"

namespace pellucid::cli {
namespace {

struct FragmentsFlags {
  std::string output;
  RenderFlags render;
  RunFlags run;
  SequenceFlags sequence;
};

DeepHeader headerOf(const Shot& shot, const FrameRun& frame) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  DeepHeader header;
  header.display = gbuffer.display;
  header.data = gbuffer.data;
  header.pixelAspect = gbuffer.pixelAspect;
  header.channels = recordChannels();
  header.attributes = frame.with({{"pellucid:note", "oit.* are not premultiplied: do not composite them"}});
  header.chromaticities = chromaticitiesToWrite(shot.opaque.space);
  if (shot.hasScene) header.camera = &shot.camera;
  return header;
}

void fragmentsVerb(const FragmentsFlags& flags, const FrameRun& frame, const std::shared_ptr<KeptWork>& kept) {
  const Threads threads(flags.run.threads);
  Request request = flags.render.request();
  request.paint = PaintSorted{};  // lists are not weighed, so no weight is fitted to them
  Compositor compositor(
      request, [](const std::string& note) { say(note); }, frame.watcher(), kept);
  const Shot& shot = compositor.shot();
  DeepWriter writer(flags.output, headerOf(shot, frame));
  RowGatherer rows(shot.opaque.gbuffer.data, shot.opaque.metresPerUnit, writer);
  const RunCounts counts = compositor.listFragments(request, [&](const FragmentLists& lists) { rows.add(lists); });
  writer.finish();
  nlohmann::json report{{"output", flags.output}, {"fragments", counts.fragments}};
  reportSpace(shot.opaque.space, report);
  reportRun(flags.run, compositor.journal().stages, counts, compositor.device(), report);
}

}  // namespace

void addFragments(CLI::App& app) {
  auto flags = std::make_shared<FragmentsFlags>();
  CLI::App* verb = app.add_subcommand("fragments", "The exact fragment lists at pixel centres, as a deep EXR");
  RenderVerb what;
  what.weighs = false;
  what.passes = false;
  what.edges = false;
  what.bends = false;
  what.resolves = false;
  flags->render.addTo(*verb, what);
  verb->add_option("-o,--output", flags->output, "Deep EXR to write")->required();
  flags->run.addTo(*verb);
  flags->sequence.addTo(*verb);
  verb->callback([verb, flags] {
    const auto kept = std::make_shared<KeptWork>(flags->render.scene.device);
    overFrames(*verb, flags->sequence,
               {flags->run.json, [&](const FrameRun& frame) { fragmentsVerb(*flags, frame, kept); }});
  });
}

}  // namespace pellucid::cli
