#include "python/native/steps.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/results.h"
#include "composite/cli/study_files.h"
#include "composite/compare/page.h"
#include "composite/deep/flatten.h"
#include "composite/pipeline/compositor.h"
#include "composite/pipeline/output_layers.h"
#include "gbuffer/errors.h"
#include "gbuffer/planes_io.h"
#include "python/native/arrays.h"
#include "python/native/plain.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

using Notes = std::vector<std::string>;

// The number of threads while a verb works, where one was asked for.
std::unique_ptr<cli::Threads> threadsOf(const cli::RunFlags& run) {
  return run.threads > 0 ? std::make_unique<cli::Threads>(run.threads) : nullptr;
}

py::dict planesOf(const OitPlanes& planes, const std::shared_ptr<const void>& owner) {
  py::dict views;
  views["radiance"] = viewOf(planes.radiance, owner);
  views["weight"] = viewOf(planes.weight, owner);
  views["opacity"] = viewOf(planes.opacity, owner);
  views["depth"] = viewOf(planes.depth, owner);
  views["light"] = viewOf(planes.light, owner);
  views["front_depth"] = viewOf(planes.frontZ, owner);
  views["solid"] = viewOf(planes.solid, owner);
  if (planes.scatters()) views["refraction"] = viewOf(planes.refraction, owner);
  if (planes.scatters()) views["diffuse_depth"] = viewOf(planes.diffuseZ, owner);
  if (planes.disperses()) views["dispersion"] = viewOf(planes.dispersion, owner);
  return views;
}

struct Accumulated {
  std::vector<PassPlanes> passes;
  RunCounts counts;
  Stages stages;
  std::string device;
  Notes notes;
};

void accumulateInto(Accumulated& made, const Words& words) {
  const cli::Listener listener(made.notes);
  const Parsed<cli::AccumulateFlags> parsed("accumulate", words);
  const auto threads = threadsOf(parsed.flags.run);
  const Request request = parsed.flags.request();
  Compositor compositor(request, [](const std::string& note) { cli::say(note); });
  made.counts = compositor.accumulate(request, [&](PassPlanes&& pass) { made.passes.push_back(std::move(pass)); });
  if (!parsed.flags.output.empty()) writePasses(parsed.flags.output, made.passes);
  made.stages = compositor.journal().stages;
  made.device = compositor.device();
}

struct Resolved {
  ResolvedPlanes result;
  Stages stages;
  Notes notes;
};

void resolveInto(Resolved& made, const Words& words) {
  const cli::Listener listener(made.notes);
  const Parsed<cli::ResolveFlags> parsed("resolve", words);
  const cli::ResolveFlags& flags = parsed.flags;
  const auto threads = threadsOf(flags.run);
  const ColourRequest colour = flags.colour.request();
  flags.preview.check(colour, flags.colour.assetRoot, true);
  Journal journal([](const std::string& note) { cli::say(note); });
  made.result = resolvePlanes(flags.request(), journal);
  const ResolvedPlanes& result = made.result;
  if (!flags.output.empty())
    cli::say(writeOver(flags.output, result.opaque, &result.camera, result.picture, result.layers,
                       {{"pellucid:method", result.info.method}}));
  flags.preview.write(colour, flags.colour.assetRoot, result.opaque.space, result.picture.rgba);
  made.stages = journal.stages;
}

struct Flattened {
  FlatPicture picture;
  Stages stages;
  Notes notes;
};

void flattenInto(Flattened& made, const Words& words) {
  const cli::Listener listener(made.notes);
  const Parsed<cli::FlattenFlags> parsed("flatten", words);
  const auto threads = threadsOf(parsed.flags.run);
  made.picture = cli::flattenFiles(parsed.flags, made.stages);
}

struct Studied {
  StudyOutcome outcome;
  ColourSpace space;
  Notes notes;
};

void studyInto(Studied& made, const Words& words) {
  const cli::Listener listener(made.notes);
  const Parsed<cli::StudyFlags> parsed("study", words);
  const cli::StudyFlags& flags = parsed.flags;
  const auto threads = threadsOf(flags.run);
  const Request base = flags.base();
  const std::vector<StudyCandidate> candidates = flags.candidates(base);
  Compositor compositor(base, [](const std::string& note) { cli::say(note); });
  if (!flags.folder.empty()) cli::makeFolder(flags.folder);
  made.outcome = runStudy(compositor, candidates, flags.repeats);
  made.space = compositor.shot().opaque.space;
  if (!flags.folder.empty()) cli::writeStudy(flags.folder, compositor.shot().opaque, made.outcome);
}

}  // namespace

py::dict accumulate(const Words& words) {
  const auto made = std::make_shared<Accumulated>();
  {
    const py::gil_scoped_release unlocked;
    accumulateInto(*made, words);
  }
  py::list passes;
  for (const PassPlanes& pass : made->passes) passes.append(planesOf(pass.planes, made));
  py::dict found;
  found["passes"] = passes;
  found["method"] = made->passes.empty() ? "" : made->passes[0].planes.info.method;
  found["statistics"] = plainOf(cli::statisticsOf(made->stages, made->counts, made->device));
  found["notes"] = made->notes;
  return found;
}

py::dict resolve(const Words& words) {
  const auto made = std::make_shared<Resolved>();
  {
    const py::gil_scoped_release unlocked;
    resolveInto(*made, words);
  }
  const ResolvedPlanes& result = made->result;
  const Window& data = result.opaque.gbuffer.data;
  py::dict found;
  found["picture"] = viewOf(result.picture.rgba, made);
  found["touched"] = viewOf(result.picture.touched, made);
  found["light"] = viewOf(result.veil.light, made);
  found["transmission"] = viewOf(result.veil.transmission, made);
  found["front_depth"] = viewOf(result.veil.frontZ, made);
  found["layers"] = viewsOf(result.layers, made);
  found["window"] = py::make_tuple(data.x0, data.y0, data.x1, data.y1);
  found["space"] = result.opaque.space.name;
  found["statistics"] = plainOf(cli::statisticsOf(made->stages, {}, result.device));
  found["notes"] = made->notes;
  return found;
}

py::dict flatten(const Words& words) {
  const auto made = std::make_shared<Flattened>();
  {
    const py::gil_scoped_release unlocked;
    flattenInto(*made, words);
  }
  const FlatPicture& picture = made->picture;
  py::dict found;
  found["light"] = viewOf(picture.light, made);
  found["opacity"] = viewOf(picture.opacity, made);
  found["front_depth"] = viewOf(picture.frontZ, made);
  found["window"] = py::make_tuple(picture.data.x0, picture.data.y0, picture.data.x1, picture.data.y1);
  found["samples"] = picture.samples;
  found["notes"] = made->notes;
  return found;
}

py::dict compare(const Words& words) {
  nlohmann::json report;
  bool differs = false;
  {
    const py::gil_scoped_release unlocked;
    const Parsed<cli::CompareFlags> parsed("compare", words);
    const cli::CompareFlags& flags = parsed.flags;
    const ExrDocument a = readExr(flags.a), b = readExr(flags.b);
    const CompareReport found = compareExr(a, b, flags.settings());
    if (!flags.html.empty()) writePage(flags.html, comparePage(a, b, found));
    report = cli::jsonOf(found);
    differs = found.verdict == Verdict::failed;
  }
  py::dict found = plainOf(report);
  found["same"] = !differs;
  return found;
}

py::dict study(const Words& words) {
  const auto made = std::make_shared<Studied>();
  {
    const py::gil_scoped_release unlocked;
    studyInto(*made, words);
  }
  py::list pictures;
  for (const Image<glm::vec3>& picture : made->outcome.pictures) pictures.append(viewOf(picture, made));
  py::dict found;
  found["rows"] = plainOf(cli::jsonOf(made->outcome.rows, made->space));
  found["pictures"] = pictures;
  found["machine"] = made->outcome.machine;
  found["notes"] = made->notes;
  return found;
}

}  // namespace pellucid::python
