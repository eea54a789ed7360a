#include "gbuffer/deep_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gbuffer/channels.h"
#include "gbuffer/errors.h"
#include "gbuffer/lower_case.h"

namespace pellucid {
namespace {

class Finder {
 public:
  Finder(const std::vector<NamedChannel>& named, DeepChannels& channels) : named_(named), channels_(channels) {}
  int optional(const std::string& name) {
    const std::string found = nameOf(name);
    if (found.empty()) return -1;
    channels_.names.push_back(found);
    return static_cast<int>(channels_.names.size()) - 1;
  }
  bool has(std::initializer_list<const char*> names) const {
    return std::all_of(names.begin(), names.end(), [&](const char* name) { return !nameOf(name).empty(); });
  }

 private:
  // The channel of that very name; else one of no layer in other letters; else the only one of any layer.
  std::string nameOf(const std::string& name) const {
    const auto isNamed = [&](const NamedChannel& channel) { return channel.channel->name == name; };
    if (std::any_of(named_.begin(), named_.end(), isNamed)) return name;
    if (name.find('.') != std::string::npos) return "";
    std::string plain, layered;
    bool two = false;
    for (const NamedChannel& channel : named_) {
      if (channel.suffix != lowerCase(name)) continue;
      std::string& slot = channel.layers.empty() ? plain : layered;
      two |= !slot.empty() && !channel.layers.empty();
      slot = channel.channel->name;
    }
    return !plain.empty() ? plain : two ? "" : layered;
  }
  const std::vector<NamedChannel>& named_;
  DeepChannels& channels_;
};

std::string namesOf(const ExrPart& part) {
  std::vector<std::string> names;
  for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string titleOf(const ExrPart& part) {
  return (part.name.empty() ? "without a name" : part.name) + (part.view.empty() ? "" : " (view " + part.view + ")");
}

bool isIn(const std::vector<std::string>& views, const std::string& view) {
  return std::find(views.begin(), views.end(), view) != views.end();
}

// Whether the file's only part holds several views, told apart by the names of their channels.
bool sharesViews(const ExrDocument& document) {
  return document.parts.size() == 1 && document.parts[0].view.empty() && document.views.size() > 1;
}

// Of such a part the view to read; "" of others.
std::string viewInPart(const ExrDocument& document, const std::string& view, std::string& note) {
  if (!sharesViews(document)) return "";
  if (!view.empty()) return view;
  note = fmt::format("{}: of the views {} of its deep samples {} is taken; --view names another", document.path,
                     fmt::join(document.views, ", "), document.views[0]);
  return document.views[0];
}

// The part to read: the first deep one of the view. Parts of no view go by their names, as the note says them.
int deepPart(const ExrDocument& document, const std::string& view, std::string& note) {
  int found = -1, deep = 0;
  std::string all;
  for (std::size_t i = 0; i < document.parts.size(); ++i) {
    const ExrPart& part = document.parts[i];
    if (!part.deep) continue;
    ++deep;
    all += (all.empty() ? "" : ", ") + titleOf(part);
    const bool named = !part.view.empty() ? part.view == view : part.name == view;
    const bool holds = view.empty() || named || (sharesViews(document) && isIn(document.views, view));
    if (found < 0 && holds) found = static_cast<int>(i);
  }
  if (deep == 0)
    throw MeaningError(fmt::format("{}: found a flat picture ({}), expected deep samples", document.path,
                                   document.parts.empty() ? "" : namesOf(document.parts[0])));
  if (found < 0 && sharesViews(document))
    throw MeaningError(fmt::format("{}: --view: found the views {}, expected {}", document.path,
                                   fmt::join(document.views, ", "), view));
  if (found < 0)
    throw MeaningError(fmt::format("{}: --view: found the deep parts {}, expected one whose view or name is {}",
                                   document.path, all, view));
  if (deep > 1 && view.empty())
    note = fmt::format("{}: of {} deep parts {} is taken; --view names another", document.path, deep,
                       titleOf(document.parts[static_cast<std::size_t>(found)]));
  return found;
}

}  // namespace

bool isDeep(const ExrDocument& document) {
  return !document.parts.empty() &&
         std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
}

bool tellsViews(const ExrDocument& document) {
  return !document.views.empty() ||
         std::count_if(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; }) > 1;
}

DeepChannels resolveDeep(const ExrDocument& document, const std::string& view) {
  const std::string& path = document.path;
  DeepChannels channels;
  channels.part = deepPart(document, view, channels.note);
  const ExrPart& part = document.parts[static_cast<std::size_t>(channels.part)];
  channels.chromaticities = chromaticitiesOf(part);
  channels.latLong = part.attributes.contains("envmap");  // of a cube map readExr() has said so
  const std::string sharedView = viewInPart(document, view, channels.note);
  std::vector<NamedChannel> named = nameChannels(document);
  std::erase_if(named, [&](const NamedChannel& channel) { return channel.part != channels.part; });
  // Parts' names are layers to nameChannels; inside of one part they tell nothing apart.
  if (!part.name.empty())
    for (NamedChannel& channel : named)
      if (channel.channel->name.find('.') == std::string::npos) channel.layers.clear();
  if (!sharedView.empty()) std::erase_if(named, [&](const NamedChannel& one) { return one.view != sharedView; });
  Finder find(named, channels);
  if (!find.has({"Z", "R", "G", "B"}))
    throw MeaningError(
        fmt::format("{}: found deep channels {}, expected Z, R, G, B and an opacity", path, namesOf(part)));
  channels.z = find.optional("Z");
  channels.zBack = find.optional("ZBack");
  channels.light = {find.optional("R"), find.optional("G"), find.optional("B")};
  channels.alpha = find.optional("A");
  channels.colouredOpacity = true;
  if (find.has({"AR", "AG", "AB"})) {
    channels.opacity = {find.optional("AR"), find.optional("AG"), find.optional("AB")};
  } else if (find.has({"RA", "GA", "BA"})) {
    channels.opacity = {find.optional("RA"), find.optional("GA"), find.optional("BA")};
  } else if (channels.alpha >= 0) {
    channels.opacity = {channels.alpha, channels.alpha, channels.alpha};
    channels.colouredOpacity = false;
  } else {
    throw MeaningError(
        fmt::format("{}: found deep channels {}, expected A, or AR, AG, AB, or RA, GA, BA", path, namesOf(part)));
  }
  if (find.has({"oit.coverage", "oit.t.R", "oit.t.G", "oit.t.B", "oit.delta.X", "oit.delta.Y", "oit.D2"})) {
    channels.coverage = find.optional("oit.coverage");
    channels.transmission = {find.optional("oit.t.R"), find.optional("oit.t.G"), find.optional("oit.t.B")};
    channels.offset = {find.optional("oit.delta.X"), find.optional("oit.delta.Y")};
    channels.variance = find.optional("oit.D2");
  }
  return channels;
}

DeepChannels resolveDeep(const std::string& path, const std::string& view) {
  return resolveDeep(readExr(path), view);
}

void expectCameraPicture(const DeepChannels& channels, const std::string& path) {
  if (channels.latLong)
    throw MeaningError(
        fmt::format("{}: attribute envmap: found a lat-long map, expected a picture that a camera has taken", path));
}

}  // namespace pellucid
