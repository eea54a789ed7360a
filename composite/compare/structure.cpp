#include "composite/compare/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "composite/sequence/digest.h"

namespace pellucid {
namespace {

// Follow from pixels and layout, which are compared for themselves.
const std::set<std::string> kCompared{"channels",           "dataWindow", "displayWindow", "chunkCount",
                                      "maxSamplesPerPixel", "name",       "type",          "version"};
// When a picture was made, and from what.
const std::set<std::string> kClock{"capDate", "utcOffset", "DateTime", "Date", "RenderTime", kDigestAttribute};

std::string prefixOf(const ExrDocument& document, const ExrPart& part) {
  return document.parts.size() > 1 && !part.name.empty() ? part.name + "." : "";
}

const ExrPart* matchingPart(const ExrDocument& a, std::size_t index, const ExrDocument& b) {
  if (a.parts.size() == 1 && b.parts.size() == 1) return &b.parts[0];
  for (const ExrPart& part : b.parts)
    if (part.name == a.parts[index].name) return &part;
  return nullptr;
}

std::string partName(const ExrPart& part) {
  return part.name.empty() ? "the picture" : "part " + part.name;
}

std::string valueText(const ExrAttribute& attribute) {
  const bool printable = std::all_of(attribute.bytes.begin(), attribute.bytes.end(),
                                     [](char c) { return static_cast<unsigned char>(c) >= 32; });
  if (attribute.type == "string" && printable) return "'" + attribute.bytes.substr(0, 80) + "'";
  std::string hex;
  for (std::size_t i = 0; i < std::min<std::size_t>(attribute.bytes.size(), 16); ++i)
    hex += fmt::format("{:02x}", static_cast<unsigned char>(attribute.bytes[i]));
  return attribute.type + " " + hex + (attribute.bytes.size() > 16 ? "..." : "");
}

}  // namespace

std::string windowText(const Window& window) {
  return fmt::format("({}, {})-({}, {})", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

std::vector<ChannelPair> pairChannels(const ExrDocument& a, const ExrDocument& b, CompareReport& report) {
  std::vector<ChannelPair> pairs;
  std::set<const ExrPart*> met;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const ExrPart& partA = a.parts[i];
    const ExrPart* partB = matchingPart(a, i, b);
    if (!partB) {
      report.structure.push_back(fmt::format("{} is only in the first file", partName(partA)));
      continue;
    }
    met.insert(partB);
    if (partA.data != partB->data)
      report.structure.push_back(fmt::format("{}: data window {} against {}", partName(partA), windowText(partA.data),
                                             windowText(partB->data)));
    if (partA.display != partB->display)
      report.structure.push_back(fmt::format("{}: display window {} against {}", partName(partA),
                                             windowText(partA.display), windowText(partB->display)));
    if (partA.deep != partB->deep) {
      report.structure.push_back(fmt::format("{}: {} against {}", partName(partA), partA.deep ? "deep" : "flat",
                                             partB->deep ? "deep" : "flat"));
      continue;
    }
    for (const ExrChannel& channel : partA.channels) {
      const std::string full = prefixOf(a, partA) + channel.name;
      const ExrChannel* other = partB->find(channel.name);
      if (!other) {
        report.structure.push_back(fmt::format("channel {} is only in the first file", full));
        continue;
      }
      if (other->type != channel.type)
        report.structure.push_back(
            fmt::format("channel {}: {} against {}", full, nameOf(channel.type), nameOf(other->type)));
      const std::size_t dot = full.rfind('.');
      pairs.push_back({dot == std::string::npos ? "" : full.substr(0, dot), full, &partA, partB, &channel, other});
    }
    for (const ExrChannel& channel : partB->channels)
      if (!partA.find(channel.name))
        report.structure.push_back(
            fmt::format("channel {} is only in the second file", prefixOf(b, *partB) + channel.name));
  }
  for (const ExrPart& part : b.parts)
    if (!met.contains(&part)) report.structure.push_back(fmt::format("{} is only in the second file", partName(part)));
  return pairs;
}

void compareAttributes(const ExrDocument& a, const ExrDocument& b, const CompareSettings& settings,
                       CompareReport& report) {
  const auto ignored = [&](const std::string& name) {
    return kCompared.contains(name) || kClock.contains(name) ||
           std::find(settings.ignoredAttributes.begin(), settings.ignoredAttributes.end(), name) !=
               settings.ignoredAttributes.end();
  };
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const ExrPart& partA = a.parts[i];
    const ExrPart* partB = matchingPart(a, i, b);
    if (!partB) continue;
    const std::string where = a.parts.size() > 1 ? partName(partA) + ": " : "";
    for (const auto& [name, value] : partA.attributes) {
      if (ignored(name)) continue;
      const auto other = partB->attributes.find(name);
      if (other == partB->attributes.end())
        report.metadata.push_back(fmt::format("{}attribute {} is only in the first file", where, name));
      else if (!(other->second == value))
        report.metadata.push_back(
            fmt::format("{}attribute {}: {} against {}", where, name, valueText(value), valueText(other->second)));
    }
    for (const auto& [name, value] : partB->attributes)
      if (!ignored(name) && !partA.attributes.contains(name))
        report.metadata.push_back(fmt::format("{}attribute {} is only in the second file", where, name));
  }
}

}  // namespace pellucid
