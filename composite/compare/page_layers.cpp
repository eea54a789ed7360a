#include "composite/compare/page_layers.h"

#include "gbuffer/channels.h"

namespace pellucid {

std::vector<const ExrChannel*> shownChannels(const ExrPart& part, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  std::vector<const ExrChannel*> shown{part.find(prefix + "R"), part.find(prefix + "G"), part.find(prefix + "B")};
  if (shown[0] && shown[1] && shown[2]) return shown;
  for (const ExrChannel& channel : part.channels)
    if (channel.name.rfind('.') == (layer.empty() ? std::string::npos : layer.size()) &&
        channel.name.compare(0, prefix.size(), prefix) == 0)
      return {&channel, &channel, &channel};
  return {};
}

bool areColours(const std::vector<const ExrChannel*>& channels) {
  const std::string& name = channels[0]->name;
  const auto dot = name.rfind('.');
  return channels[0] != channels[1] && !saysData(dot == std::string::npos ? "" : name.substr(0, dot));
}

Image<glm::vec3> layerPicture(const ExrPart& part, const std::vector<const ExrChannel*>& channels, int step) {
  const int width = (part.data.width() + step - 1) / step, height = (part.data.height() + step - 1) / step;
  Image<glm::vec3> picture(width, height);
  const auto row = static_cast<std::size_t>(part.data.width());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y * step) * row + static_cast<std::size_t>(x * step);
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = channels[static_cast<std::size_t>(c)]->at(pixel);
    }
  return picture;
}

}  // namespace pellucid
