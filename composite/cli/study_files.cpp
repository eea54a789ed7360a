#include "composite/cli/study_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "composite/cli/colour_flags.h"
#include "composite/cli/messages.h"
#include "composite/compare/page.h"
#include "composite/study/plot.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

void writeText(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) throw ResourceError(path + ": cannot be written");
  file.commit();
}

}  // namespace

nlohmann::json jsonOf(const std::vector<StudyRow>& rows, const ColourSpace& space) {
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
                    {"spread", row.spread},
                    {"firstSeconds", row.firstSeconds},
                    {"peakBytes", row.peakBytes},
                    {"stages", stages},
                    {"bitsPerPixel", row.bits},
                    {"passes", row.passes},
                    {"paretoFront", row.front}});
    if (!row.weight.empty()) list.back()["weight"] = row.weight;
    reportSpace(space, list.back());
  }
  return list;
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw ResourceError(fmt::format("{}: cannot be made: {}", folder, error.message()));
}

void writeStudy(const std::string& folder, const OpaqueFile& opaque, const StudyOutcome& outcome,
                const DisplayShader& shown, double exposure) {
  const std::vector<StudyRow>& rows = outcome.rows;
  std::vector<PagePicture> pictures;
  for (std::size_t i = 0; i < rows.size(); ++i) pictures.push_back({rowName(rows[i]), outcome.pictures[i], 0});
  const std::string base = folder + "/study.";
  const Plot plot = studyPlot(rows);
  writeText(base + "txt", outcome.machine + "\n\n" + studyText(rows));
  writeText(base + "csv", studyCsv(rows));
  writeText(base + "json", jsonOf(rows, opaque.space).dump(2) + "\n");
  writeText(base + "svg", plotSvg(plot));
  if (!writePlotPng(base + "png", plot)) say("study.png has no labels: no font was found (fonts-dejavu-core)");
  Page page;
  page.title = "What each method pays to miss the truth";
  page.lines = {opaque.document.path, "Errors are measured in " + opaque.space.name + ".", outcome.machine};
  for (const StudyRow& row : rows)
    if (!row.weight.empty()) page.lines.push_back(rowName(row) + ": weight " + row.weight);
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
  page.displays = {shown};
  page.exposure = exposure;
  writePage(base + "html", page);
}

}  // namespace pellucid::cli
