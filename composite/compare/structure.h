// Which channels of two files belong together, and in what the files differ apart from pixels.
#pragma once
#include <string>
#include <vector>

#include "composite/compare/compare.h"

namespace pellucid {

struct ChannelPair {
  std::string layer, name;  // name with its layer and part, as the report says it
  const ExrPart* partA = nullptr;
  const ExrPart* partB = nullptr;
  const ExrChannel* a = nullptr;
  const ExrChannel* b = nullptr;
};

// Channels that both files have, in the order of a. Appends what is missing or of another kind to report.structure.
std::vector<ChannelPair> pairChannels(const ExrDocument& a, const ExrDocument& b, CompareReport& report);

// Appends attributes that differ to report.metadata.
void compareAttributes(const ExrDocument& a, const ExrDocument& b, const CompareSettings& settings,
                       CompareReport& report);

std::string windowText(const Window& window);  // "(0, 0)-(639, 359)", both ends included

}  // namespace pellucid
