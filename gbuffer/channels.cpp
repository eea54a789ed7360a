#include "gbuffer/channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "gbuffer/errors.h"
#include "gbuffer/lower_case.h"
#include "gbuffer/producers.h"

namespace pellucid {
namespace {

// Layers that mean "the picture" to Nuke, Gaffer and others, and say nothing more.
constexpr const char* kEmptyWords[] = {"rgba", "rgb", "main", "other"};
constexpr const char* kBeautyWords[] = {"combined", "beauty", "ci", "c", "color", "colour", "finalimage"};
constexpr const char* kDepthWords[] = {"depth",   "z",          "zdepth",     "depthz", "z_depth",
                                       "depth_z", "vrayzdepth", "worlddepth", "hitpz",  "scenedepth"};
// Unreal's layers: this and the name of the pass.
constexpr const char* kUnrealPrefix = "finalimagemovierenderqueue_";
// Layers with R, G, B that are no picture, for files whose only colour has an unknown name.
constexpr const char* kDataWords[] = {"n",      "nn",       "normal", "normals", "p",       "position", "depth",
                                      "vector", "velocity", "motion", "uv",      "st",      "ao",       "worlddepth",
                                      "shadow", "albedo",   "crypto", "id",      "diffcol", "mist",     "vrayzdepth"};

template <class Range>
bool isOneOf(const std::string& word, const Range& words) {
  return std::any_of(std::begin(words), std::end(words), [&](const char* known) { return word == known; });
}

std::vector<std::string> split(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '.')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

// "rgba_left" and "rgba.left" without their view.
std::string withoutView(const std::string& partName, const std::string& view) {
  if (view.empty() || partName.size() <= view.size() || !partName.ends_with(view)) return partName;
  const std::size_t separator = partName.size() - view.size() - 1;
  return partName[separator] == '_' || partName[separator] == '.' ? partName.substr(0, separator) : partName;
}

// Parts that nobody named: libraries number them.
bool isNumbered(const std::string& word) {
  for (const std::string front : {"subimage", "part"})
    if (word.size() > front.size() && word.starts_with(front))
      return std::all_of(word.begin() + static_cast<std::ptrdiff_t>(front.size()), word.end(),
                         [](char c) { return c >= '0' && c <= '9'; });
  return false;
}

bool saysNothing(const std::string& word) {
  return word.empty() || isOneOf(word, kEmptyWords) || isNumbered(word);
}

// Of a file beside the picture, whose layers go by the name that was given; where it has one layer, by that alone.
NamedChannel nameBeside(const ExrPart& part, int index, const ExrChannel& channel) {
  const auto layerOf = [](const std::string& name) { return name.substr(0, name.rfind('.') + 1); };
  const bool oneLayer = std::all_of(part.channels.begin(), part.channels.end(), [&](const ExrChannel& other) {
    return layerOf(other.name) == layerOf(channel.name);
  });
  const std::string inside = oneLayer && !part.name.empty() ? "" : layerOf(channel.name);
  NamedChannel named;
  named.part = index;
  named.channel = &channel;
  named.layerName = part.name.empty() ? inside : part.name + "." + inside;
  named.fullName = named.layerName + channel.name.substr(layerOf(channel.name).size());
  while (named.layerName.ends_with(".")) named.layerName.pop_back();
  named.suffix = lowerCase(split(channel.name).back());
  for (const std::string& word : split(named.layerName))
    if (!saysNothing(lowerCase(word))) named.layers.push_back(lowerCase(word));
  return named;
}

NamedChannel nameOne(const ExrDocument& document, int index, const ExrChannel& channel) {
  const ExrPart& part = document.parts[static_cast<std::size_t>(index)];
  if (!part.from.empty()) return nameBeside(part, index, channel);
  const bool manyParts = document.ownParts > 1;
  const bool manyViews = document.views.size() > 1;
  NamedChannel named;
  named.part = index;
  named.channel = &channel;
  named.view = manyViews ? part.view : "";
  const bool repeats = channel.name.starts_with(part.name + ".");  // some writers say the layer twice
  named.fullName = manyParts && !part.name.empty() && !repeats ? part.name + "." + channel.name : channel.name;
  named.layerName =
      named.fullName.substr(0, named.fullName.rfind('.') == std::string::npos ? 0 : named.fullName.rfind('.'));

  std::vector<std::string> words = split(channel.name);
  if (manyParts && !part.name.empty()) {
    std::vector<std::string> front = split(withoutView(part.name, part.view));
    if (words.size() > front.size() && std::equal(front.begin(), front.end(), words.begin())) front.clear();
    words.insert(words.begin(), front.begin(), front.end());
  }
  named.suffix = lowerCase(words.back());
  words.pop_back();
  for (const std::string& word : words) {
    if (manyViews && std::find(document.views.begin(), document.views.end(), word) != document.views.end())
      named.view = word;
    else if (!saysNothing(lowerCase(word)))
      named.layers.push_back(lowerCase(word));
  }
  // In one part, channels without a view belong to the default view.
  if (manyViews && named.view.empty() && !manyParts) named.view = document.views[0];
  return named;
}

// Whether a layer or a channel of that name is such a pass.
bool means(Pass pass, const std::string& word) {
  static constexpr const char* kNormalWords[] = {"n", "nn", "normal", "normals"};
  static constexpr const char* kPositionWords[] = {"p", "position", "pworld", "hitp", "worldposition"};
  static constexpr const char* kOcclusionWords[] = {"ao", "ambientocclusion", "ambient_occlusion", "occlusion"};
  return pass == Pass::normal     ? isOneOf(word, kNormalWords)
         : pass == Pass::position ? isOneOf(word, kPositionWords)
                                  : isOneOf(word, kOcclusionWords);
}

int colourIndex(const std::string& suffix) {
  static constexpr std::pair<const char*, int> kNames[] = {{"r", 0},   {"g", 1},     {"b", 2},    {"a", 3},
                                                           {"red", 0}, {"green", 1}, {"blue", 2}, {"alpha", 3}};
  for (const auto& [name, index] : kNames)
    if (suffix == name) return index;
  return -1;
}

int vectorIndex(const std::string& suffix) {
  if (suffix.size() == 1 && suffix[0] >= 'x' && suffix[0] <= 'z') return suffix[0] - 'x';
  const int colour = colourIndex(suffix);
  return colour < 3 ? colour : -1;
}

bool startsWith(const std::vector<std::string>& words, const std::vector<std::string>& front) {
  return words.size() >= front.size() && std::equal(front.begin(), front.end(), words.begin());
}

// What a beauty shares with the passes beside it: its layers but for the last.
std::vector<std::string> familyOf(const std::vector<std::string>& layers) {
  return layers.empty() ? layers : std::vector<std::string>(layers.begin(), layers.end() - 1);
}

bool sameView(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() || a == b;
}

// 0 plain R G B, 1 a layer that names the picture, 2 something else, 3 certainly not the picture
int beautyRank(const std::vector<std::string>& layers) {
  if (layers.empty()) return 0;
  std::string last = layers.back();
  const bool unreal = last.starts_with(kUnrealPrefix);
  if (unreal) last = last.substr(std::string(kUnrealPrefix).size());
  if (isOneOf(last, kDataWords)) return 3;
  for (const char* word : {"depth", "normal", "position", "motion", "vector", "hitproxy", "mask", "crypto"})
    if (last.find(word) != std::string::npos) return 3;
  return unreal || isOneOf(last, kBeautyWords) ? 1 : 2;
}

std::string nameLayer(const BeautyChannels& beauty) {
  const std::string view = beauty.view.empty() ? "" : fmt::format(" (view {})", beauty.view);
  return (beauty.layerName.empty() ? beauty.channel[0]->name + beauty.channel[1]->name + beauty.channel[2]->name
                                   : beauty.layerName) +
         view;
}

std::vector<BeautyChannels> colourLayers(const std::vector<NamedChannel>& channels) {
  // Within a layer "R" wins over "r", and that over "red".
  std::map<std::pair<int, std::string>, BeautyChannels> layers;
  std::vector<std::pair<int, std::string>> order;
  for (const NamedChannel& named : channels) {
    const int index = colourIndex(named.suffix);
    if (index < 0 || named.channel->bytes.empty()) continue;
    const std::pair<int, std::string> key(named.part, named.layerName);
    const auto [entry, isNew] = layers.try_emplace(key);
    BeautyChannels& beauty = entry->second;
    if (isNew) order.push_back(key);
    beauty.part = named.part;
    beauty.layerName = named.layerName;
    beauty.view = named.view;
    beauty.layers = named.layers;
    const ExrChannel*& slot = beauty.channel[index];
    if (!slot || slot->name.size() > named.channel->name.size() ||
        (slot->name.size() == named.channel->name.size() && named.channel->name < slot->name))
      slot = named.channel;
  }
  std::vector<BeautyChannels> found;
  for (const auto& key : order)
    if (const BeautyChannels& layer = layers[key]; layer.channel[0] && layer.channel[1] && layer.channel[2])
      found.push_back(layer);
  return found;
}

[[noreturn]] void refuseTwo(const std::string& path, const char* what, const std::string& first,
                            const std::string& second, const char* flag) {
  throw MeaningError(
      fmt::format("{}: two {}: found {} and {}, expected one, or {} NAME", path, what, first, second, flag));
}

}  // namespace

bool isDepth(const NamedChannel& named, const std::vector<NamedChannel>& channels) {
  const auto sibling = [&](const char* suffix) {
    return std::any_of(channels.begin(), channels.end(), [&](const NamedChannel& other) {
      return other.part == named.part && other.layerName == named.layerName && other.suffix == suffix;
    });
  };
  if (named.channel->bytes.empty()) return false;  // deep
  if (named.suffix == "z" && sibling("x") && sibling("y")) return false;
  std::string last = named.layers.empty() ? "" : named.layers.back();
  if (last.starts_with(kUnrealPrefix)) last = last.substr(std::string(kUnrealPrefix).size());
  if (named.suffix == "z") return named.layers.empty() || isOneOf(last, kDepthWords);
  if (isOneOf(named.suffix, kDepthWords)) return true;
  if (!isOneOf(last, kDepthWords)) return false;
  if (named.suffix == "r" || named.suffix == "red" || named.suffix == "v") return !sibling("z");
  return false;
}

std::vector<NamedChannel> ownChannels(const ExrDocument& document, const std::vector<NamedChannel>& channels) {
  std::vector<NamedChannel> own = channels;
  std::erase_if(own, [&](const NamedChannel& c) { return static_cast<std::size_t>(c.part) >= document.ownParts; });
  return own;
}

std::vector<NamedChannel> nameChannels(const ExrDocument& document) {
  std::vector<NamedChannel> named;
  for (std::size_t part = 0; part < document.parts.size(); ++part)
    for (const ExrChannel& channel : document.parts[part].channels)
      named.push_back(nameOne(document, static_cast<int>(part), channel));
  return named;
}

std::string listNames(const std::vector<NamedChannel>& channels, std::size_t most) {
  if (channels.empty()) return "nothing";
  std::string text;
  for (std::size_t i = 0; i < std::min(most, channels.size()); ++i) text += (i ? ", " : "") + channels[i].fullName;
  return channels.size() > most ? fmt::format("{} and {} more", text, channels.size() - most) : text;
}

BeautyChannels resolveBeauty(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                             const std::string& layer, const std::string& view, const Producer* producer) {
  std::vector<BeautyChannels> layers = colourLayers(channels);
  if (!layer.empty()) {
    const auto named = [&](const BeautyChannels& candidate) {
      return candidate.layerName == layer ||
             (candidate.view == layer && !layer.empty() && beautyRank(candidate.layers) < 2) ||
             document.parts[static_cast<std::size_t>(candidate.part)].name == layer;
    };
    std::string found;
    for (const BeautyChannels& candidate : layers) found += (found.empty() ? "" : ", ") + nameLayer(candidate);
    std::erase_if(layers, [&](const BeautyChannels& candidate) { return !named(candidate); });
    if (layers.empty())
      throw MeaningError(fmt::format("{}: --beauty: found the layers {}, expected '{}' with R, G and B", document.path,
                                     found.empty() ? "(none with colour)" : found, layer));
  }
  int best = 3;
  for (const BeautyChannels& candidate : layers) best = std::min(best, beautyRank(candidate.layers));
  if (layer.empty()) {
    if (best == 3) layers.clear();
  }
  std::erase_if(layers, [&](const BeautyChannels& candidate) { return beautyRank(candidate.layers) != best; });
  if (layers.empty()) {
    for (const NamedChannel& channel : channels)
      if (channel.suffix == "ry" || channel.suffix == "by" || channel.channel->name == "Y")
        throw InputError(fmt::format("{}: found luminance-chroma ({}), expected R, G and B: convert it first",
                                     document.path, listNames(channels)));
    const bool deep =
        std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
    throw MeaningError(fmt::format("{}: no colour: found {}{}, expected R, G and B, or --beauty LAYER", document.path,
                                   deep ? "deep samples only: " : "", listNames(channels)));
  }
  if (layers.size() > 1 && producer && producer->givesWay)
    std::erase_if(layers, [&](const BeautyChannels& candidate) {
      return !candidate.layers.empty() && candidate.layers[0] == producer->givesWay;
    });
  const std::string wanted = !view.empty() ? view : document.views.empty() ? "" : document.views[0];
  if (!view.empty() && std::find(document.views.begin(), document.views.end(), view) == document.views.end())
    throw MeaningError(fmt::format("{}: --view: found {}, expected {}", document.path,
                                   document.views.empty() ? "no views" : "views without that name", view));
  if ((layers.size() > 1 && !document.views.empty()) || !view.empty())
    std::erase_if(layers, [&](const BeautyChannels& candidate) { return !sameView(candidate.view, wanted); });
  if (layers.empty())
    throw MeaningError(fmt::format("{}: no colour of view {}, expected one, or --beauty NAME", document.path, wanted));
  if (layers.size() > 1) refuseTwo(document.path, "pictures", nameLayer(layers[0]), nameLayer(layers[1]), "--beauty");
  for (const ExrChannel* channel : layers[0].channel)
    if (channel && channel->type == PixelType::uint32)
      throw MeaningError(
          fmt::format("{}: channel {}: found uint, expected half or float colour", document.path, channel->name));
  return layers[0];
}

const NamedChannel& resolveDepth(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                 const BeautyChannels& beauty, const std::string& name, const Producer* producer) {
  std::vector<const NamedChannel*> found;
  const auto collect = [&](auto&& condition) {
    for (const NamedChannel& channel : channels)
      if (condition(channel)) found.push_back(&channel);
  };
  const auto ofView = [&](const NamedChannel& channel) { return sameView(channel.view, beauty.view); };
  if (!name.empty()) {
    collect([&](const NamedChannel& c) {
      return (c.fullName == name || c.channel->name == name) && !c.channel->bytes.empty();
    });
  } else {
    if (producer) collect([&](const NamedChannel& c) { return ofView(c) && isDepthOf(*producer, channels, c); });
    if (found.empty()) collect([&](const NamedChannel& c) { return ofView(c) && isDepth(c, channels); });
  }
  const auto keep = [&](auto&& condition) {
    std::vector<const NamedChannel*> kept;
    for (const NamedChannel* channel : found)
      if (condition(*channel)) kept.push_back(channel);
    if (!kept.empty()) found = kept;
  };
  if (found.size() > 1 && !name.empty()) keep([&](const NamedChannel& c) { return c.fullName == name; });
  if (found.size() > 1 && !beauty.view.empty()) keep([&](const NamedChannel& c) { return c.view == beauty.view; });
  if (const auto family = familyOf(beauty.layers); found.size() > 1 && !family.empty())
    keep([&](const NamedChannel& c) { return startsWith(c.layers, family); });
  if (found.empty())
    throw MeaningError(fmt::format("{}: no depth: found {}; expected {}", document.path, listNames(channels),
                                   name.empty() ? "a Z channel, or --depth NAME" : "the channel " + name));
  if (found.size() > 1) refuseTwo(document.path, "depth channels", found[0]->fullName, found[1]->fullName, "--depth");
  if (found[0]->channel->type == PixelType::uint32)
    throw MeaningError(
        fmt::format("{}: depth {}: found uint, expected half or float", document.path, found[0]->fullName));
  return *found[0];
}

bool isPassName(const std::string& name) {
  const std::string last = lowerCase(split(name).back());
  return means(Pass::normal, last) || means(Pass::position, last) || means(Pass::occlusion, last) ||
         (name.starts_with("light.") && name.size() > 6);
}

bool saysData(const std::string& layer) {
  return !layer.empty() && beautyRank({lowerCase(split(layer).back())}) == 3;
}

std::optional<PassChannels> resolvePass(const std::vector<NamedChannel>& channels, const BeautyChannels& beauty,
                                        Pass pass) {
  const auto named = [&](const std::string& word) { return means(pass, word); };
  std::vector<PassChannels> found;
  std::vector<bool> beside;
  const auto family = familyOf(beauty.layers);
  for (const NamedChannel& channel : channels) {
    if (channel.channel->bytes.empty() || channel.channel->type == PixelType::uint32) continue;
    if (!sameView(channel.view, beauty.view)) continue;
    // A vector is a layer with three suffixes; occlusion may also be a channel of that name.
    const bool single = pass == Pass::occlusion && named(channel.suffix);
    const int index = single ? 0 : vectorIndex(channel.suffix);
    if (index < 0 || (!single && (channel.layers.empty() || !named(channel.layers.back())))) continue;
    auto entry = std::find_if(found.begin(), found.end(), [&](const PassChannels& p) {
      return !single && p.part == channel.part && p.layerName == channel.layerName;
    });
    if (entry == found.end()) {
      found.push_back({channel.part, single ? channel.fullName : channel.layerName, {}});
      beside.push_back(startsWith(channel.layers, family));
      entry = found.end() - 1;
    }
    if (!entry->channel[index]) entry->channel[index] = channel.channel;
  }
  std::optional<PassChannels> choice;
  for (const bool wanted : {true, false})
    for (std::size_t i = 0; i < found.size(); ++i) {
      const bool whole = pass == Pass::occlusion ? found[i].channel[0] != nullptr
                                                 : found[i].channel[0] && found[i].channel[1] && found[i].channel[2];
      if (!choice && whole && beside[i] == wanted) choice = found[i];
    }
  return choice;
}

std::optional<PassChannels> positionsOf(const std::vector<NamedChannel>& channels, const NamedChannel& depth) {
  if (depth.suffix != "z") return std::nullopt;
  PassChannels pass{depth.part, depth.layerName, {nullptr, nullptr, depth.channel}};
  for (const NamedChannel& channel : channels) {
    const bool beside = channel.part == depth.part && channel.layerName == depth.layerName;
    if (beside && channel.channel->type != PixelType::uint32 && channel.suffix.size() == 1 &&
        channel.suffix[0] >= 'x' && channel.suffix[0] < 'z')
      pass.channel[channel.suffix[0] - 'x'] = channel.channel;
  }
  // Depth that is written three times is no position.
  const bool whole = pass.channel[0] && pass.channel[1] && pass.channel[0]->bytes != depth.channel->bytes;
  return whole ? std::optional<PassChannels>(pass) : std::nullopt;
}

}  // namespace pellucid
