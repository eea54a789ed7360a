#include "gbuffer/side_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "gbuffer/channels.h"
#include "gbuffer/errors.h"
#include "gbuffer/lower_case.h"

namespace pellucid {
namespace {

std::string windowText(const Window& w) {
  return fmt::format("({}, {})-({}, {})", w.x0, w.y0, w.x1 - 1, w.y1 - 1);
}

//   name  of its layers; "" for depth
void append(const SideFile& side, const std::string& flag, const std::string& name, ExrDocument& document) {
  ExrDocument beside = readExr(side.path);
  const Window display = document.parts[0].display;
  bool any = false;
  for (ExrPart& part : beside.parts) {
    if (part.deep) continue;
    if (part.display != display)
      throw MeaningError(fmt::format("{}: {}: found display window {}, expected {} of {}", side.path, flag,
                                     windowText(part.display), windowText(display), document.path));
    if (part.attributes.contains("envmap"))  // of a cube map readExr() has said so
      throw MeaningError(
          fmt::format("{}: {}: attribute envmap: found a lat-long map, expected a picture that a camera has taken",
                      side.path, flag));
    part.from = side.path;
    part.name = name;
    document.parts.push_back(std::move(part));
    any = true;
  }
  if (!any) throw MeaningError(fmt::format("{}: {}: found deep samples, expected a flat picture", side.path, flag));
}

bool same(const NamedChannel& a, const NamedChannel& b) {
  return a.channel->type == b.channel->type && a.channel->bytes == b.channel->bytes;
}

}  // namespace

std::optional<SideFile> sideFileOf(const std::string& depth) {
  const std::string text = lowerCase(depth);
  if (text.ends_with(".exr")) return SideFile{"", depth, ""};
  const auto colon = text.rfind(".exr:");
  if (colon == std::string::npos || colon + 5 == text.size()) return std::nullopt;
  return SideFile{"", depth.substr(0, colon + 4), depth.substr(colon + 5)};
}

SideFile readAov(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || !lowerCase(text).ends_with(".exr"))
    throw UsageError(fmt::format("--aov: found '{}', expected NAME=FILE.exr, such as N=normals.exr", text));
  const std::string name = text.substr(0, equals);
  if (!isPassName(name))
    throw UsageError(fmt::format(
        "--aov: found '{}', expected N, P, AO or light.NAME before the equals sign: other passes are not read", name));
  return {name, text.substr(equals + 1), ""};
}

ExrDocument readWithSides(const std::string& path, const ReadOptions& options) {
  ExrDocument document = readExr(path);
  const bool deep =
      std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
  if (deep && (options.depthFile || !options.aovs.empty()))
    throw UsageError(fmt::format("{}: --depth FILE and --aov are for flat pictures: found deep samples", path));
  for (const SideFile& aov : options.aovs) append(aov, "--aov " + aov.name, aov.name, document);
  if (options.depthFile) append(*options.depthFile, "--depth", "", document);
  return document;
}

const NamedChannel& depthBeside(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                const SideFile& side) {
  std::vector<NamedChannel> own;
  for (const NamedChannel& channel : channels)
    if (const ExrPart& part = document.parts[static_cast<std::size_t>(channel.part)];
        part.from == side.path && part.name.empty())
      own.push_back(channel);
  const auto chosen = [&](const NamedChannel& one) -> const NamedChannel& {
    return *std::find_if(channels.begin(), channels.end(),
                         [&](const NamedChannel& channel) { return channel.channel == one.channel; });
  };
  const auto refuse = [&](const std::string& expected) {
    return MeaningError(fmt::format("{}: --depth: found {}, expected {}", side.path, listNames(own), expected));
  };
  if (!side.channel.empty()) {
    for (const NamedChannel& channel : own)
      if (channel.channel->name == side.channel) return chosen(channel);
    throw refuse("the channel " + side.channel);
  }
  std::vector<NamedChannel> depths;
  for (const NamedChannel& channel : own)
    if (isDepth(channel, own)) depths.push_back(channel);
  if (depths.size() == 1) return chosen(depths[0]);
  if (depths.empty() && own.size() == 1) return chosen(own[0]);
  const auto colour = [&](const char* suffix) {
    return std::find_if(own.begin(), own.end(), [&](const NamedChannel& channel) { return channel.suffix == suffix; });
  };
  const auto r = colour("r"), g = colour("g"), b = colour("b");
  if (depths.empty() && r != own.end() && g != own.end() && b != own.end() && same(*r, *g) && same(*r, *b))
    return chosen(*r);
  throw refuse(fmt::format("one of them as --depth {}:CHANNEL", side.path));
}

}  // namespace pellucid
