#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/preview_flags.h"
#include "composite/cli/render_flags.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/compositor.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

// Of the sample `bottles`, 99.7% of the pixels lie within 0.02 of 64 samples; 16 bring that to 99.9% at twice the time.
constexpr int kDefaultPasses = 8;

struct CompositeFlags {
  std::string output;
  RenderFlags render;
  PreviewFlags preview;
  RunFlags run;
  bool explain = false;
};

std::vector<std::string> viewsOf(const std::string& path) {
  const ExrDocument document = readExr(path);
  if (document.views.size() < 2)
    throw MeaningError(fmt::format("{}: --view: found {}, expected several views for all", path,
                                   document.views.empty() ? "no views" : "the view " + document.views[0]));
  return document.views;
}

// Extra layers of the second view and further ones are named after it where they would lie in one part.
std::vector<std::string> writeViews(const std::string& path, const std::vector<std::string>& views,
                                    const std::vector<std::unique_ptr<Compositor>>& compositors,
                                    const std::vector<Result>& results) {
  std::vector<PictureOfView> pictures;
  std::vector<std::vector<ExtraLayer>> renamed(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const OpaqueFile& file = compositors[i]->shot().opaque;
    const bool beside = i > 0 && file.choice.beautyPart == pictures[0].file.choice.beautyPart;
    if (beside) renamed[i] = results[i].layers;
    for (ExtraLayer& layer : renamed[i]) layer.name += (layer.name.empty() ? "" : ".") + views[i];
    pictures.push_back(
        {file, results[i].picture.rgba, results[i].picture.touched, beside ? renamed[i] : results[i].layers});
  }
  return writePictures(path, pictures, compositors[0]->attributes(results[0]));
}

void composite(const CompositeFlags& flags) {
  const Threads threads(flags.run.threads);
  const Request request = flags.render.request();
  flags.preview.check(request.shot.colour);
  Compositor compositor(request, [](const std::string& note) { say(note); });
  if (flags.explain) {
    for (const std::string& line : describe(compositor.plan(request), compositor.facts())) fmt::print("{}\n", line);
    return;
  }
  Result result = compositor.run(request);
  nlohmann::json report{{"output", flags.output}, {"method", request.method}};
  reportSpace(compositor.shot().opaque.space, report);
  reportError(flags.run, result, report);
  say(result.stages.time("write", [&] { return compositor.write(flags.output, result); }));
  flags.preview.write(request.shot.colour, compositor.shot().opaque.space, result.picture.rgba);
  reportRun(flags.run, result.stages, result.counts, result.device, report);
}

// Every view of the file with its own camera, and all of them in one file again.
void compositeViews(const CompositeFlags& flags) {
  const Threads threads(flags.run.threads);
  if (flags.preview.wanted())
    throw UsageError("--preview: found it with --view all, expected one view: a PNG shows one picture");
  const std::vector<std::string> views = viewsOf(flags.render.opaque);
  std::vector<std::unique_ptr<Compositor>> compositors;
  std::vector<Result> results;
  nlohmann::json report{{"output", flags.output}, {"views", nlohmann::json::array()}};
  for (const std::string& view : views) {
    say("view " + view);
    const Request request = flags.render.requestOfView(view, views);
    compositors.push_back(std::make_unique<Compositor>(request, [](const std::string& note) { say(note); }));
    Compositor& compositor = *compositors.back();
    if (compositor.shot().deepOpaque)
      throw UsageError(request.shot.opaque + ": --view: found all with a deep picture, expected one view of it");
    if (flags.explain) {
      for (const std::string& line : describe(compositor.plan(request), compositor.facts()))
        fmt::print("{}: {}\n", view, line);
      continue;
    }
    results.push_back(compositor.run(request));
    nlohmann::json each{{"view", view}, {"method", request.method}};
    reportSpace(compositor.shot().opaque.space, each);
    reportError(flags.run, results.back(), each);
    report["views"].push_back(each);
  }
  if (flags.explain) return;
  Stages stages;
  RunCounts counts = results.front().counts;
  for (const Result& result : results) {
    for (const auto& [name, seconds] : result.stages.seconds()) stages.add(name, seconds);
    if (&result != &results.front()) counts.add(result.counts);
  }
  say(stages.time("write", [&] { return writeViews(flags.output, views, compositors, results); }));
  reportRun(flags.run, stages, counts, results.front().device, report);
}

}  // namespace

void addComposite(CLI::App& app) {
  auto flags = std::make_shared<CompositeFlags>();
  CLI::App* verb = app.add_subcommand(
      "composite", "Composite transparent geometry onto an opaque render: exactly, unless --method says otherwise");
  RenderVerb what;
  what.defaultPasses = kDefaultPasses;
  what.allViews = true;
  what.blurs = true;
  flags->render.addTo(*verb, what);
  verb->add_option("-o,--output", flags->output, "EXR to write")->required();
  flags->preview.addTo(*verb);
  verb->add_flag("--explain", flags->explain, "Print what would be done and why, and stop before anything is drawn");
  flags->run.addTo(*verb);
  verb->callback([flags] { flags->render.read.view == "all" ? compositeViews(*flags) : composite(*flags); });
}

}  // namespace pellucid::cli
