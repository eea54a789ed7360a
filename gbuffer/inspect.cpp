#include "gbuffer/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gbuffer/channels.h"
#include "gbuffer/deep_channels.h"
#include "gbuffer/deep_io.h"
#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"
#include "gbuffer/part_camera.h"
#include "gbuffer/side_files.h"

namespace pellucid {
namespace {

using nlohmann::json;

// Names in files need not be UTF-8, which JSON is; one odd byte must not lose the report.
std::string printable(const std::string& text) {
  std::string clean;
  for (const char c : text)
    clean += static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126 ? '?' : c;
  return clean;
}

json windowJson(const Window& window) {
  return {{"x", window.x0}, {"y", window.y0}, {"width", window.width()}, {"height", window.height()}};
}

// JSON has no infinities.
json numberJson(double value) {
  return std::isfinite(value) ? json(value) : json(fmt::format("{}", value));
}

json attributeJson(const ExrAttribute& attribute) {
  json report = {{"type", printable(attribute.type)}};
  if (attribute.type == "string")
    report["value"] = printable(attribute.bytes.substr(0, 200));
  else
    report["bytes"] = attribute.bytes.size();
  return report;
}

json partJson(const ExrPart& part) {
  json channels = json::array();
  for (const ExrChannel& channel : part.channels)
    channels.push_back({{"name", printable(channel.name)}, {"type", nameOf(channel.type)}});
  json attributes = json::object();
  for (const auto& [name, attribute] : part.attributes) attributes[printable(name)] = attributeJson(attribute);
  static constexpr const char* kLevels[] = {"one", "mip map", "rip map"};
  return {{"name", printable(part.name)},
          {"view", printable(part.view)},
          {"display", windowJson(part.display)},
          {"data", windowJson(part.data)},
          {"pixelAspect", numberJson(part.pixelAspect)},
          {"compression", part.compression},
          {"storage", std::string(part.deep ? "deep " : "") + (part.tiled ? "tiles" : "scan lines")},
          {"levels", kLevels[part.levelMode]},
          {"channels", channels},
          {"attributes", attributes}};
}

// Pixels of each decade of metres, so that a wrong unit or an unknown far value shows.
json histogramJson(const Image<float>& viewZ) {
  std::map<int, std::size_t> decades;
  std::size_t nothing = 0;
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
  for (std::size_t i = 0; i < viewZ.size(); ++i) {
    const float z = viewZ[i];
    if (!std::isfinite(z)) {
      ++nothing;
      continue;
    }
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
    ++decades[static_cast<int>(std::floor(std::log10(static_cast<double>(z))))];
  }
  json bins = json::array();
  for (const auto& [decade, count] : decades)
    bins.push_back({{"from", std::pow(10.0, decade)}, {"to", std::pow(10.0, decade + 1)}, {"pixels", count}});
  json report = {{"nothing", nothing}, {"decades", bins}};
  if (farthest > 0.0f) report["nearest"] = nearest, report["farthest"] = farthest;
  return report;
}

json cameraJson(const Camera& camera) {
  json matrix = json::array();
  for (int row = 0; row < 4; ++row) {
    json numbers = json::array();
    for (int column = 0; column < 4; ++column) numbers.push_back(numberJson(camera.viewFromWorld[column][row]));
    matrix.push_back(numbers);
  }
  return {{"origin", printable(camera.origin)},
          {"projection", camera.orthographic ? "orthographic" : "perspective"},
          {"viewFromWorld", matrix},
          {"focal", {numberJson(camera.focal.x), numberJson(camera.focal.y)}},
          {"centre", {numberJson(camera.centre.x), numberJson(camera.centre.y)}},
          {"range", {numberJson(camera.rangeNear), numberJson(camera.rangeFar)}}};
}

// The camera that a part states, checked where it can be.
json cameraReport(const OpaqueFile& file, bool verify) {
  if (!file.gbuffer.camera) return json();
  json report = cameraJson(*file.gbuffer.camera);
  report["residualPixels"] = json();
  if (!verify) return report;
  try {
    const std::optional<double> residual = verifyCamera(file, *file.gbuffer.camera);
    if (residual) report["residualPixels"] = *residual;
  } catch (const MeaningError& error) {
    report["refusal"] = printable(error.what());
  }
  return report;
}

// A picture of deep samples: what its channels are taken for, and how many samples there are.
json deepJson(const ExrDocument& document, const ReadOptions& options, std::vector<std::string>& notes) {
  const DeepChannels channels = resolveDeep(document, options.view);
  expectCameraPicture(channels, document.path);
  if (!channels.note.empty()) notes.push_back(channels.note);
  const auto named = [&](int index) {
    return index < 0 ? json() : json(printable(channels.names[static_cast<std::size_t>(index)]));
  };
  json colour = json::array(), opacity = json::array();
  for (const int index : channels.light) colour.push_back(named(index));
  if (channels.colouredOpacity)
    for (const int index : channels.opacity) opacity.push_back(named(index));
  if (channels.alpha >= 0) opacity.push_back(named(channels.alpha));
  std::uint64_t samples = 0, most = 0;
  float nearest = std::numeric_limits<float>::infinity(), farthest = -nearest;
  DeepReader reader(document.path, channels.part, {channels.names[static_cast<std::size_t>(channels.z)]});
  DeepRows rows;
  for (int y = reader.data().y0; y < reader.data().y1; y = rows.window.y1) {
    rows = reader.read(y, reader.data().y1, std::uint64_t{1} << 21, std::move(rows));
    samples += rows.offsets.back();
    for (std::size_t i = 0; i + 1 < rows.offsets.size(); ++i)
      most = std::max(most, rows.offsets[i + 1] - rows.offsets[i]);
    for (const float z : rows.channels[0])
      if (std::isfinite(z)) nearest = std::min(nearest, z), farthest = std::max(farthest, z);
  }
  json depth{{"channel", named(channels.z)},
             {"back", named(channels.zBack)},
             {"kind", !options.depthKind.empty()           ? options.depthKind
                      : nearest < 0.0f && farthest <= 0.0f ? depthKindText({DepthMeaning::negative})
                                                           : "planar"},
             {"metresPerUnit", numberJson(options.metresPerUnit.value_or(1.0))}};
  if (nearest <= farthest) depth["least"] = nearest, depth["most"] = farthest;
  json report{{"deep",
               {{"part", channels.part},
                {"colour", colour},
                {"opacity", opacity},
                {"record", channels.hasRecord()},
                {"samples", samples},
                {"mostInAPixel", most}}},
              {"depth", depth}};
  OpaqueFile file;
  file.document.path = document.path;
  const ExrPart& part = document.parts[static_cast<std::size_t>(channels.part)];
  file.gbuffer.display = part.display;
  readCamera(part, options.metresPerUnit.value_or(1.0), file);
  notes.insert(notes.end(), file.notes.begin(), file.notes.end());
  report["camera"] = cameraReport(file, false);
  return report;
}

json understoodJson(const OpaqueFile& file) {
  const OpaqueChoice& choice = file.choice;
  const auto partName = [&](int part) { return printable(file.document.parts[static_cast<std::size_t>(part)].name); };
  json beauty = json::array();
  for (const std::string& channel : choice.beautyChannel)
    if (!channel.empty()) beauty.push_back(printable(channel));
  json report;
  report["beauty"] = {{"part", choice.beautyPart},
                      {"partName", partName(choice.beautyPart)},
                      {"channels", beauty},
                      {"alpha", file.gbuffer.hasAlpha},
                      {"notFinite", choice.nonFiniteColour}};
  report["depth"] = {{"part", choice.depthPart},
                     {"partName", partName(choice.depthPart)},
                     {"channel", printable(choice.depthChannel)},
                     {"file", printable(choice.depthFile)},
                     {"kind", choice.depthKind},
                     {"far", numberJson(choice.farValue)},
                     {"least", numberJson(choice.least)},
                     {"most", numberJson(choice.most)},
                     {"metresPerUnit", numberJson(file.metresPerUnit)},
                     {"notFinite", choice.nonFiniteDepth},
                     {"precision", numberJson(static_cast<double>(file.gbuffer.depthPrecision))},
                     {"histogram", histogramJson(file.gbuffer.viewZ)}};
  report["preset"] =
      choice.preset.empty() ? json() : json({{"name", choice.preset}, {"by", printable(choice.presetBy)}});
  report["colourSpace"] = {{"name", printable(file.space.name)}, {"by", nameOf(file.space.source)}};
  report["normals"] = !file.gbuffer.normal.empty();
  report["occlusion"] = !file.gbuffer.occlusion.empty();
  report["camera"] = cameraReport(file, true);
  return report;
}

std::string windowLine(const json& window) {
  return fmt::format("{} x {} at ({}, {})", window["width"].get<int>(), window["height"].get<int>(),
                     window["x"].get<int>(), window["y"].get<int>());
}

std::string textOf(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string cameraText(const json& camera) {
  if (camera.is_null()) return "camera: none in the file\n";
  return fmt::format("camera: {}, {}{}\n", camera["origin"].get<std::string>(), camera["projection"].get<std::string>(),
                     camera.contains("refusal") ? "; " + camera["refusal"].get<std::string>()
                     : camera["residualPixels"].is_null()
                         ? ", not checked"
                         : fmt::format(", {:.3g} pixels from the positions", camera["residualPixels"].get<double>()));
}

std::string deepText(const json& deep, const json& depth) {
  const auto list = [](const json& names) {
    std::string text;
    for (const json& name : names) text += " " + textOf(name);
    return text;
  };
  std::string text = fmt::format("deep picture: {} samples, at most {} in a pixel\n", deep["samples"].dump(),
                                 deep["mostInAPixel"].dump());
  text += fmt::format("colour:{}\nopacity:{}\n", list(deep["colour"]), list(deep["opacity"]));
  text += fmt::format("depth: {}{}, {}, 1 unit is {} m", textOf(depth["channel"]),
                      depth["back"].is_null() ? "" : " to " + textOf(depth["back"]), textOf(depth["kind"]),
                      textOf(depth["metresPerUnit"]));
  if (depth.contains("least"))
    text += fmt::format(", {:.6g} to {:.6g}", depth["least"].get<double>(), depth["most"].get<double>());
  return text + "\n";
}

}  // namespace

nlohmann::json inspectExr(const std::string& path, const ReadOptions& options) {
  ExrDocument document = readWithSides(path, options);
  json report;
  report["file"] = printable(path);
  report["parts"] = json::array();
  for (std::size_t i = 0; i < document.ownParts; ++i) report["parts"].push_back(partJson(document.parts[i]));
  std::vector<std::string> notes = document.notes;
  const bool deep =
      std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
  try {
    if (deep) {
      notes.clear();  // that they are not read here: they are
      report.update(deepJson(document, options, notes));
    } else {
      const OpaqueFile file = interpretOpaque(std::move(document), options);
      report.update(understoodJson(file));
      notes = file.notes;
    }
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    report["refusal"] = printable(error.what());
    report["refusalCode"] = error.exitCode();
  }
  report["notes"] = json::array();
  for (const std::string& note : notes) report["notes"].push_back(printable(note));
  return report;
}

std::string inspectionText(const nlohmann::json& report) {
  std::string text = report["file"].get<std::string>() + "\n";
  for (std::size_t i = 0; i < report["parts"].size(); ++i) {
    const json& part = report["parts"][i];
    const std::string name = part["name"].get<std::string>();
    text += fmt::format("part {}{}: {}, display {}, {}, {}, {} channels\n", i, name.empty() ? "" : " (" + name + ")",
                        windowLine(part["data"]), windowLine(part["display"]), part["storage"].get<std::string>(),
                        part["compression"].get<std::string>(), part["channels"].size());
    for (const json& channel : part["channels"])
      text += fmt::format("  {} {}\n", channel["name"].get<std::string>(), channel["type"].get<std::string>());
  }
  if (report.contains("beauty")) {
    std::string names;
    for (const json& channel : report["beauty"]["channels"]) names += " " + channel.get<std::string>();
    const auto inPart = [&](const json& choice) {
      return report["parts"].size() > 1 ? fmt::format(" of part {}", textOf(choice["partName"])) : std::string();
    };
    if (!report["preset"].is_null())
      text += fmt::format("preset: {}, by {}\n", textOf(report["preset"]["name"]), textOf(report["preset"]["by"]));
    text += fmt::format("beauty:{}{}\n", names, inPart(report["beauty"]));
    const json& space = report["colourSpace"];
    text += fmt::format("colours in {}, said by {}\n", textOf(space["name"]), textOf(space["by"]));
    const json& depth = report["depth"];
    text += fmt::format("depth: {}{}, {}, nothing hit from {}\n", textOf(depth["channel"]), inPart(depth),
                        depth["kind"].get<std::string>(), textOf(depth["far"]));
    for (const json& bin : depth["histogram"]["decades"])
      text += fmt::format("  {:g} to {:g} m: {} pixels\n", bin["from"].get<double>(), bin["to"].get<double>(),
                          bin["pixels"].get<std::size_t>());
    text += fmt::format("  nothing: {} pixels\n", depth["histogram"]["nothing"].get<std::size_t>());
    text += fmt::format("normals: {}\nocclusion: {}\n", report["normals"].get<bool>() ? "yes" : "no",
                        report["occlusion"].get<bool>() ? "yes" : "no");
    text += cameraText(report["camera"]);
  }
  if (report.contains("deep")) text += deepText(report["deep"], report["depth"]) + cameraText(report["camera"]);
  for (const json& note : report["notes"]) text += "note: " + note.get<std::string>() + "\n";
  if (report.contains("refusal")) text += "cannot be composited onto: " + report["refusal"].get<std::string>() + "\n";
  return text;
}

}  // namespace pellucid
