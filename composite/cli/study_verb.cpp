#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/render.h"
#include "composite/cli/results.h"
#include "composite/cli/shot.h"
#include "composite/cli/verbs.h"
#include "composite/compare/page.h"
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
  RunFlags run;
  int samples = 1;
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
  for (const StudyRow& row : rows)
    list.push_back({{"method", row.method},
                    {"mean", row.error.mean},
                    {"rmse", row.error.rmse},
                    {"p99", row.error.p99},
                    {"max", row.error.maximum},
                    {"relativeMse", row.relativeSquare},
                    {"notFinite", row.error.nonFinite},
                    {"seconds", row.seconds},
                    {"bitsPerPixel", row.bits},
                    {"passes", row.passes},
                    {"paretoFront", row.front}});
  return list;
}

// What a row says of its method. The GL pass of the phenomenological model keeps the sums of `weighted`.
void describe(StudyRow& row, const std::optional<ChosenMethod>& chosen) {
  const ChosenMethod known = chosen ? *chosen : *chooseMethod("weighted");
  row.bits = row.method == "over" ? 0 : known.method->bits(known.order);
  row.passes = row.method == "over" ? 2 : known.method->passes;
}

void study(const StudyFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  std::vector<std::optional<ChosenMethod>> chosen;
  for (const std::string& name : flags.methods) {
    chosen.push_back(chooseMethod(name));
    if (!chosen.back() && name != "phenomenological")
      throw UsageError(fmt::format("--methods: found '{}', expected phenomenological, {}", name, methodNames()));
  }
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages);
  const GBuffer& gbuffer = shot->opaque.gbuffer;
  std::error_code error;
  std::filesystem::create_directories(flags.folder, error);
  if (error) throw ResourceError(fmt::format("{}: cannot be made: {}", flags.folder, error.message()));
  RenderSettings settings;
  settings.samples = flags.samples;
  settings.pass.surroundings = shot->surroundings;
  flags.scene.applyTo(settings.pass);
  flags.method.applyTo(settings.pass, shot->camera);
  std::unique_ptr<GlContext> context;
  std::unique_ptr<TransparentPass> pass;
  if (shot->hasScene) {
    context = std::make_unique<GlContext>(flags.scene.device);
    pass = std::make_unique<TransparentPass>(*context, shot->scene, gbuffer, shot->camera);
  }
  if (flags.method.isAuto()) fitShotWeight(pass.get(), shot->deep, gbuffer, settings.pass, stages);
  // One untimed run first: shaders compile on first use.
  {
    RenderCounts counts;
    Stages unused;
    RenderSettings warm = settings;
    warm.samples = 1;
    renderVeil(pass.get(), shot->deep, warm, gbuffer, unused, counts);
  }
  const auto render = [&](const RenderSettings& how, double& seconds) {
    RenderCounts counts;
    Stages unused;
    const auto start = std::chrono::steady_clock::now();
    const Veil veil = renderVeil(pass.get(), shot->deep, how, gbuffer, unused, counts);
    Picture picture = compose(veil, gbuffer);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(picture.rgba);
  };
  std::vector<StudyRow> rows(1);
  rows[0].method = "over";
  RenderSettings exact = settings;
  exact.sortedTruth = true;
  const Image<glm::vec4> truth = render(exact, rows[0].seconds);
  rows[0].error = measureError(truth, truth);
  describe(rows[0], std::nullopt);
  Page page;
  page.pictures.push_back({"over", colourOf(truth)});
  for (std::size_t i = 0; i < flags.methods.size(); ++i) {
    spdlog::info("study: {} ({} of {})", flags.methods[i], i + 1, flags.methods.size());
    StudyRow row;
    row.method = chosen[i] ? chosen[i]->name : flags.methods[i];
    RenderSettings how = settings;
    how.listMethod = chosen[i];
    const Image<glm::vec4> picture = render(how, row.seconds);
    row.error = measureError(picture, truth);
    row.relativeSquare = relativeSquareError(picture, truth);
    describe(row, chosen[i]);
    page.pictures.push_back({row.method, colourOf(picture)});
    rows.push_back(std::move(row));
  }
  markFront(rows);
  const std::string base = flags.folder + "/study.";
  writeText(base + "txt", studyText(rows));
  writeText(base + "csv", studyCsv(rows));
  writeText(base + "json", jsonOf(rows).dump(2) + "\n");
  writeText(base + "svg", studySvg(rows));
  page.title = "What each method pays to miss the truth";
  page.lines = {flags.opaque + ", " + std::to_string(flags.samples) + " samples a pixel, weight " +
                weightText(settings.pass.weight)};
  PageTable table{"Error against sorted over", studyHead(), {}};
  for (const StudyRow& row : rows) table.rows.push_back(studyCells(row));
  page.tables.push_back(std::move(table));
  page.plotSvg = studySvg(rows);
  writePage(base + "html", page);
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
  verb->add_option("-o,--output", flags->folder, "Folder for study.txt, .csv, .json, .svg and .html")->required();
  verb->add_option("--methods", flags->methods, "Methods to compare: " + methodNames())
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  verb->add_option("--aa", flags->samples, "Jittered passes, averaged")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->method.addWeightTo(*verb, true);
  verb->add_option("--threads", flags->run.threads, "0 uses every core")->check(CLI::NonNegativeNumber);
  verb->add_flag("--json", flags->run.json, "Print the table as JSON");
  verb->callback([flags] { study(*flags); });
}

}  // namespace pellucid::cli
