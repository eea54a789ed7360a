#include "gbuffer/channel_encoder.h"

#include <tbb/parallel_for.h>

#include <stdexcept>

namespace pellucid {
namespace {

std::string channelName(const ExtraLayer& layer, const std::string& suffix) {
  return layer.name.empty() ? suffix : suffix.empty() ? layer.name : layer.name + "." + suffix;
}

}  // namespace

std::vector<ExrChannel> channelsOf(const std::vector<ExtraLayer>& layers, const Window& data, PixelType type,
                                   ChannelEncoder& encoder) {
  std::vector<ExrChannel> channels;
  std::vector<const Image<float>*> planes;
  for (const ExtraLayer& layer : layers)
    for (const auto& [suffix, plane] : layer.channels) {
      if (plane.width() != data.width() || plane.height() != data.height())
        throw std::logic_error(channelName(layer, suffix) + ": a layer of another size than the data window");
      channels.push_back({channelName(layer, suffix), type, {}});
      planes.push_back(&plane);
    }
  std::vector<ChannelEncoder> encoders(channels.size());
  tbb::parallel_for(std::size_t{0}, channels.size(), [&](std::size_t c) {
    const Image<float>& plane = *planes[c];
    channels[c].bytes.resize(plane.size() * bytesOf(type));
    for (std::size_t i = 0; i < plane.size(); ++i) encoders[c].put(channels[c], i, plane[i]);
  });
  for (const ChannelEncoder& each : encoders) encoder.add(each);
  return channels;
}

}  // namespace pellucid
