#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/fog_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/render.h"
#include "composite/cli/results.h"
#include "composite/cli/scatter_flags.h"
#include "composite/cli/shot.h"
#include "composite/cli/stochastic_flags.h"
#include "composite/cli/verbs.h"
#include "composite/compare/page.h"
#include "composite/study/flip.h"
#include "composite/study/plot.h"
#include "composite/study/study.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

struct StudyFlags {
  std::string opaque, folder;
  std::vector<std::string> scenes;
  std::vector<std::string> methods{"phenomenological", "sum",        "average",   "blended",   "weighted",
                                   "unsorted",         "front+tail", "wavelet:2", "moments:4", "mlab:4"};
  ReadFlags read;
  SceneFlags scene;
  MethodFlags method;
  ScatterFlags scatter;
  LookupFlags lookup;
  FoliageFlags foliage;
  FogFlags fog;
  ParticleFlags particles;
  RunFlags run;
  std::vector<int> samples{1};
  std::vector<std::string> precisions{"float"};
};

void writeText(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) throw ResourceError(path + ": cannot be written");
  file.commit();
}

Image<glm::vec3> colourOf(const Image<glm::vec4>& picture) {
  Image<glm::vec3> rgb(picture.width(), picture.height());
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = glm::vec3(picture[i]);
  return rgb;
}

nlohmann::json jsonOf(const std::vector<StudyRow>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const StudyRow& row : rows) {
    nlohmann::json stages = nlohmann::json::object();
    for (const auto& [name, seconds] : row.stages) stages[name] = seconds;
    list.push_back({{"method", row.method},
                    {"precision", row.precision},
                    {"samples", row.samples},
                    {"mean", row.error.mean},
                    {"rmse", row.error.rmse},
                    {"p99", row.error.p99},
                    {"max", row.error.maximum},
                    {"relativeMse", row.relativeSquare},
                    {"flip", row.flip},
                    {"notFinite", row.error.nonFinite},
                    {"seconds", row.seconds},
                    {"stages", stages},
                    {"bitsPerPixel", row.bits},
                    {"passes", row.passes},
                    {"paretoFront", row.front}});
  }
  return list;
}

// One row to be: a method, or the truth (nothing chosen, sorted).
struct Candidate {
  std::string name;
  std::optional<ChosenMethod> chosen;
  std::optional<StochasticSettings> stochastic;
  bool sorted = false;
  std::string precision;
  int samples = 1;
};

// Every method at every number of samples; the tiers are those of the GL pass's sums alone.
std::vector<Candidate> candidatesOf(const StudyFlags& flags) {
  std::vector<Candidate> candidates;
  for (const int samples : flags.samples) {
    candidates.push_back({"over", std::nullopt, std::nullopt, true, "double", samples});
    for (const std::string& name : flags.methods) {
      const std::optional<ChosenMethod> chosen = chooseMethod(name);
      const std::optional<StochasticSettings> stochastic = StochasticFlags().settings(name, samples);
      if (!chosen && !stochastic && name != "phenomenological")
        throw UsageError(fmt::format("--methods: found '{}', expected phenomenological, {}, {}", name, kStochasticNames,
                                     methodNames()));
      if (stochastic)
        candidates.push_back({name, std::nullopt, stochastic, false, "double", samples});
      else if (chosen)
        candidates.push_back({chosen->name, chosen, std::nullopt, false, chosen->method->precision, samples});
      else
        for (const std::string& precision : flags.precisions)
          candidates.push_back({name, std::nullopt, std::nullopt, false, precision, samples});
    }
  }
  return candidates;
}

// What a row says of its method. The GL pass of the phenomenological model keeps the sums of `weighted`; the exact tier
// keeps lists.
void describe(StudyRow& row, const Candidate& candidate, const RenderCounts& counts) {
  row.method = candidate.name;
  row.precision = candidate.precision;
  row.samples = candidate.samples;
  if (candidate.stochastic) {
    row.bits = stochasticBits(*candidate.stochastic);
    row.passes = stochasticPasses(*candidate.stochastic);
  } else if (candidate.chosen) {
    row.bits = candidate.chosen->method->bits(candidate.chosen->order);
    row.passes = candidate.chosen->method->passes;
  } else if (candidate.sorted || candidate.precision == "exact") {
    row.passes = 2;  // solids, then lists
  } else {
    row.bits = counts.bitsPerPixel;
    row.passes = counts.passes;
  }
}

void writeAll(const StudyFlags& flags, const std::vector<StudyRow>& rows, const std::vector<PagePicture>& pictures,
              const std::string& weight) {
  const std::string base = flags.folder + "/study.";
  const Plot plot = studyPlot(rows);
  writeText(base + "txt", studyText(rows));
  writeText(base + "csv", studyCsv(rows));
  writeText(base + "json", jsonOf(rows).dump(2) + "\n");
  writeText(base + "svg", plotSvg(plot));
  if (!writePlotPng(base + "png", plot)) spdlog::info("study.png has no labels: no font was found (fonts-dejavu-core)");
  Page page;
  page.title = "What each method pays to miss the truth";
  page.lines = {flags.opaque + ", weight " + weight};
  PageTable table{"Error against sorted over", studyHead(), {}};
  for (const StudyRow& row : rows) table.rows.push_back(studyCells(row));
  page.tables.push_back(std::move(table));
  const std::vector<std::string> stages = stageNames(rows);
  PageTable seconds{"Seconds per stage", {"method"}, {}};
  seconds.head.insert(seconds.head.end(), stages.begin(), stages.end());
  for (const StudyRow& row : rows) seconds.rows.push_back(stageCells(row, stages));
  page.tables.push_back(std::move(seconds));
  page.plotSvg = plotSvg(plot);
  page.pictures = pictures;
  page.right = pictures.size() > 1 ? 1 : 0;
  writePage(base + "html", page);
}

void study(const StudyFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const std::vector<Candidate> candidates = candidatesOf(flags);
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages);
  const GBuffer& gbuffer = shot->opaque.gbuffer;
  std::error_code error;
  std::filesystem::create_directories(flags.folder, error);
  if (error) throw ResourceError(fmt::format("{}: cannot be made: {}", flags.folder, error.message()));
  RenderSettings settings;
  settings.deepOpaque = shot->deepOpaque.get();
  settings.pass.surroundings = shot->surroundings;
  settings.pass.environment = shot->environment;
  flags.scene.applyTo(settings.pass);
  flags.method.applyTo(settings.pass, shot->camera);
  flags.scatter.applyTo(settings.pass);
  settings.lookup = flags.lookup.settings();
  Air air(*shot, nullptr, flags.scenes, flags.scene.options(flags.read.unit, true));
  settings.pass.fog = flags.fog.place(*shot, air, flags.read.unit, "", stages);
  settings.pass.particleLight = flags.particles.place(*shot, air, stages);
  std::unique_ptr<GlContext> context;
  std::unique_ptr<TransparentPass> pass;
  if (shot->hasScene) {
    context = std::make_unique<GlContext>(flags.scene.device);
    pass = std::make_unique<TransparentPass>(*context, shot->scene, gbuffer, shot->camera);
  }
  flags.foliage.applyTo(settings.pass, pass.get(), gbuffer, shot->camera, stages);
  if (flags.method.isAuto()) fitShotWeight(pass.get(), shot->deep, gbuffer, settings.pass, stages);
  const auto settingsFor = [&](const Candidate& candidate) {
    RenderSettings how = settings;
    how.samples = candidate.samples;
    how.sortedTruth = candidate.sorted;
    useMethod(candidate.chosen, how);
    how.stochastic = candidate.stochastic;
    how.exactSums = candidate.precision == "exact";
    if (candidate.precision == "published") {
      how.pass.tier = SumsTier::published;
      how.pass.normalisation = shading::PLD_NORMALISE_PUBLISHED;
      how.resolve.selfModulation = true;
    }
    return how;
  };
  // Untimed runs first: shaders compile on first use.
  for (const bool lists : {false, true}) {
    RenderCounts counts;
    Stages unused;
    RenderSettings warm = settings;
    warm.exactSums = lists;
    renderVeil(pass.get(), shot->deep, warm, gbuffer, shot->camera, unused, counts);
  }
  // The truth is `over` at the most samples.
  std::size_t best = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].sorted && candidates[i].samples > candidates[best].samples) best = i;
  std::vector<StudyRow> rows(candidates.size());
  std::vector<PagePicture> pictures(candidates.size());
  Image<glm::vec4> truth;
  std::unique_ptr<FlipReference> flip;
  std::vector<std::size_t> order{best};
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (i != best) order.push_back(i);
  for (std::size_t done = 0; done < order.size(); ++done) {
    const Candidate& candidate = candidates[order[done]];
    StudyRow& row = rows[order[done]];
    RenderCounts counts;
    Stages own;
    const Veil veil = renderVeil(pass.get(), shot->deep, settingsFor(candidate), gbuffer, shot->camera, own, counts);
    const Picture picture = own.time("compose", [&] { return compose(veil, gbuffer); });
    row.stages = own.seconds();
    for (const auto& [name, seconds] : row.stages) row.seconds += seconds;
    describe(row, candidate, counts);
    if (done == 0) {
      truth = picture.rgba;
      flip = std::make_unique<FlipReference>(truth);
    }
    row.error = measureError(picture.rgba, truth);
    row.relativeSquare = relativeSquareError(picture.rgba, truth);
    row.flip = meanOf(flip->map(picture.rgba));
    pictures[order[done]] = {rowName(row), colourOf(picture.rgba)};
    spdlog::info("study: {} of {}: {}, rmse {:.3g}, {:.3f} s", done + 1, order.size(), rowName(row), row.error.rmse,
                 row.seconds);
  }
  markFront(rows);
  writeAll(flags, rows, pictures, weightText(settings.pass.weight));
  for (const auto& source : shot->deep) say(source->notes());
  if (flags.run.json)
    fmt::print("{}\n", jsonOf(rows).dump(2));
  else
    fmt::print("{}", studyText(rows));
}

}  // namespace

void addStudy(CLI::App& app) {
  auto flags = std::make_shared<StudyFlags>();
  CLI::App* verb = app.add_subcommand("study", "Error against cost of the methods on a shot: table, plot, page");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("scenes", flags->scenes, "glTF, GLB or deep EXR with the transparent things")->required();
  verb->add_option("-o,--output", flags->folder, "Folder for study.txt, .csv, .json, .svg, .png and .html")->required();
  verb->add_option("--methods", flags->methods,
                   fmt::format("Methods to compare: phenomenological, {}, {}", kStochasticNames, methodNames()))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  verb->add_option("--aa", flags->samples,
                   "Jittered passes, averaged: numbers to compare; the truth is over at the most of them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  verb->add_option("--precision", flags->precisions, "Tiers of phenomenological to compare: float, exact, published")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"float", "exact", "published"}))
      ->capture_default_str();
  flags->scatter.addTo(*verb);
  flags->lookup.addTo(*verb);
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->foliage.addTo(*verb);
  flags->fog.addTo(*verb);
  flags->particles.addTo(*verb);
  flags->method.addWeightTo(*verb, true);
  verb->add_option("--threads", flags->run.threads, "0 uses every core")->check(CLI::NonNegativeNumber);
  verb->add_flag("--json", flags->run.json, "Print the table as JSON");
  verb->callback([flags] { study(*flags); });
}

}  // namespace pellucid::cli
