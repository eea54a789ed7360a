#include "python/native/steps.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

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
#include "python/native/veil_planes.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

using Notes = std::vector<std::string>;

// The number of threads while a verb works, where one was asked for.
std::unique_ptr<cli::Threads> threadsOf(const cli::RunFlags& run) {
  return run.threads > 0 ? std::make_unique<cli::Threads>(run.threads) : nullptr;
}

py::dict arraysOf(OitPlanes planes) {
  const bool scatters = planes.scatters(), disperses = planes.disperses();
  py::dict arrays;
  arrays["radiance"] = arrayOf(std::move(planes.radiance));
  arrays["weight"] = arrayOf(std::move(planes.weight));
  arrays["opacity"] = arrayOf(std::move(planes.opacity));
  arrays["depth"] = arrayOf(std::move(planes.depth));
  arrays["light"] = arrayOf(std::move(planes.light));
  arrays["front_depth"] = arrayOf(std::move(planes.frontZ));
  arrays["solid"] = arrayOf(std::move(planes.solid));
  if (scatters) arrays["refraction"] = arrayOf(std::move(planes.refraction));
  if (scatters) arrays["diffuse_depth"] = arrayOf(std::move(planes.diffuseZ));
  if (disperses) arrays["dispersion"] = arrayOf(std::move(planes.dispersion));
  return arrays;
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
  if (!flags.folder.empty()) flags.checkShown();
  Compositor compositor(base, [](const std::string& note) { cli::say(note); });
  if (!flags.folder.empty()) cli::makeFolder(flags.folder);
  made.outcome = runStudy(compositor, candidates, flags.repeats);
  made.space = compositor.shot().opaque.space;
  if (!flags.folder.empty()) flags.write(compositor.shot().opaque, made.outcome);
}

}  // namespace

py::dict accumulate(const Words& words) {
  Accumulated made;
  {
    const py::gil_scoped_release unlocked;
    accumulateInto(made, words);
  }
  py::dict found;
  found["method"] = made.passes.empty() ? "" : made.passes[0].planes.info.method;
  py::list passes;
  for (PassPlanes& pass : made.passes) passes.append(arraysOf(std::move(pass.planes)));
  found["passes"] = passes;
  found["statistics"] = plainOf(cli::statisticsOf(made.stages, made.counts, made.device));
  found["notes"] = made.notes;
  return found;
}

py::dict resolve(const Words& words) {
  Resolved made;
  {
    const py::gil_scoped_release unlocked;
    resolveInto(made, words);
  }
  ResolvedPlanes& result = made.result;
  const Window& data = result.opaque.gbuffer.data;
  py::dict found;
  found["picture"] = arrayOf(std::move(result.picture.rgba));
  found["touched"] = arrayOf(std::move(result.picture.touched));
  found["veil"] = VeilPlanes(std::move(result.veil), data);
  found["layers"] = arraysOf(std::move(result.layers));
  found["window"] = py::make_tuple(data.x0, data.y0, data.x1, data.y1);
  found["space"] = result.opaque.space.name;
  found["statistics"] = plainOf(cli::statisticsOf(made.stages, {}, result.device));
  found["notes"] = made.notes;
  return found;
}

py::dict flatten(const Words& words) {
  Flattened made;
  {
    const py::gil_scoped_release unlocked;
    flattenInto(made, words);
  }
  FlatPicture& picture = made.picture;
  py::dict found;
  found["light"] = arrayOf(std::move(picture.light));
  found["opacity"] = arrayOf(std::move(picture.opacity));
  found["front_depth"] = arrayOf(std::move(picture.frontZ));
  found["window"] = py::make_tuple(picture.data.x0, picture.data.y0, picture.data.x1, picture.data.y1);
  found["samples"] = picture.samples;
  found["notes"] = made.notes;
  return found;
}

py::dict compare(const Words& words) {
  nlohmann::json report;
  bool differs = false;
  {
    const py::gil_scoped_release unlocked;
    const Parsed<cli::CompareFlags> parsed("compare", words);
    const cli::CompareFlags& flags = parsed.flags;
    flags.check();
    const ExrDocument a = readExr(flags.a), b = readExr(flags.b);
    const CompareReport found = compareExr(a, b, flags.settings());
    flags.writeHtml(a, b, found);
    report = cli::jsonOf(found);
    differs = found.verdict == Verdict::failed;
  }
  py::dict found = plainOf(report);
  found["same"] = !differs;
  return found;
}

py::dict study(const Words& words) {
  Studied made;
  {
    const py::gil_scoped_release unlocked;
    studyInto(made, words);
  }
  py::list pictures;
  for (Image<glm::vec3>& picture : made.outcome.pictures) pictures.append(arrayOf(std::move(picture)));
  py::dict found;
  found["rows"] = plainOf(cli::jsonOf(made.outcome.rows, made.space));
  found["pictures"] = pictures;
  found["machine"] = made.outcome.machine;
  found["notes"] = made.notes;
  return found;
}

}  // namespace pellucid::python
