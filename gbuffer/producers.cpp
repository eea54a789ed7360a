#include "gbuffer/producers.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// "viewlayer.depth.z": its layers without view and empty words, and its last word.
std::string pathOf(const NamedChannel& channel) {
  std::string path;
  for (const std::string& layer : channel.layers) path += layer + ".";
  return path + channel.suffix;
}

// Ends at a dot, or is the whole.
bool endsWith(const std::string& path, const std::string& end) {
  return path.ends_with(end) && (path.size() == end.size() || path[path.size() - end.size() - 1] == '.');
}

// "z" is a channel of no layer, "depth.z" of that layer in any other, "*.t" the only channel of any layer.
bool matches(const NamedChannel& channel, const std::vector<NamedChannel>& channels, const std::string& pattern) {
  const std::string path = pathOf(channel);
  if (pattern.ends_with("*")) return path.starts_with(pattern.substr(0, pattern.size() - 1));
  if (pattern.starts_with("*."))
    return channel.suffix == pattern.substr(2) && !channel.layers.empty() &&
           std::count_if(channels.begin(), channels.end(), [&](const NamedChannel& other) {
             return other.part == channel.part && other.layerName == channel.layerName;
           }) == 1;
  return pattern.find('.') == std::string::npos ? path == pattern : endsWith(path, pattern);
}

bool carries(const ExrPart& part, const HeaderMark& mark, std::string& name) {
  for (const auto& [attribute, value] : part.attributes) {
    const bool named = mark.isPrefix ? attribute.starts_with(mark.attribute) : attribute == mark.attribute;
    if (!named || (mark.text && value.bytes.find(mark.text) == std::string::npos)) continue;
    name = attribute;
    return true;
  }
  return false;
}

std::string recognise(const Producer& row, const ExrDocument& document, const std::vector<NamedChannel>& channels) {
  std::string name;
  for (const HeaderMark& mark : row.marks)
    for (const ExrPart& part : document.parts)
      if (carries(part, mark, name)) return "attribute " + name;
  if (row.names.empty()) return "";
  for (const char* pattern : row.names) {
    const auto found = std::find_if(channels.begin(), channels.end(),
                                    [&](const NamedChannel& channel) { return matches(channel, channels, pattern); });
    if (found == channels.end()) return "";
    name = found->fullName;
  }
  return "channel " + name;
}

}  // namespace

RecognisedProducer recogniseProducer(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                     const std::string& preset) {
  if (preset != "auto") {
    for (const Producer& row : producers())
      if (preset == row.name) return {&row, "--preset"};
    throw UsageError(fmt::format("--preset: found '{}', expected auto, {}", preset, producerNames()));
  }
  for (const Producer& row : producers())
    if (std::string by = recognise(row, document, channels); !by.empty()) return {&row, std::move(by)};
  return {};
}

bool isDepthOf(const Producer& row, const std::vector<NamedChannel>& channels, const NamedChannel& channel) {
  return *row.depth && !channel.channel->bytes.empty() && matches(channel, channels, row.depth);
}

std::string producerNames() {
  std::string names;
  for (const Producer& row : producers()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

std::vector<std::string> presetChoices() {
  std::vector<std::string> names{"auto"};
  for (const Producer& row : producers()) names.emplace_back(row.name);
  return names;
}

std::string producersHelp() {
  static constexpr const char* kSpaces[] = {"in world space", "in world space with z up, turned to y up",
                                            "in camera space, left out"};
  std::string text;
  for (const Producer& row : producers()) {
    text += fmt::format("{}: {}; picture {}, alpha {}, views {}; depth {}, {}, 1 unit is {:g} m, nothing hit: {}, ",
                        row.name, row.title, row.beauty, row.alpha, row.views, *row.depth ? row.depth : "z",
                        depthKindText(parseDepthKind(row.kind)), row.unit, row.nothing);
    text += fmt::format("a pixel holds {}; colours {}; normals {}; ambient occlusion {}; light groups {}; camera {}; ",
                        row.filter,
                        *row.space ? row.space + std::string(" unless chromaticities say otherwise")
                                   : std::string("as chromaticities say"),
                        kSpaces[static_cast<int>(row.normals)], row.occlusion, row.lightGroups, row.camera);
    if (*row.pixelFilter) text += fmt::format("pixel filter {} by default; ", row.pixelFilter);
    text += fmt::format("facts: {}\n", row.source);
  }
  return text;
}

}  // namespace pellucid
