#include "gbuffer/supersampled.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gbuffer/channel_encoder.h"
#include "gbuffer/errors.h"
#include "gbuffer/lower_case.h"

namespace pellucid {
namespace {

bool divides(const Window& samples, int n) {
  return samples.x0 % n == 0 && samples.y0 % n == 0 && samples.x1 % n == 0 && samples.y1 % n == 0;
}

// Value of each pixel, which `valueOf` makes of its first sample's place.
template <class T, class Value>
Image<T> pixelImage(int width, int height, int n, const Value& valueOf) {
  Image<T> pixels(width / n, height / n);
  tbb::parallel_for(0, pixels.height(), [&](int y) {
    for (int x = 0; x < pixels.width(); ++x) pixels.at(x, y) = valueOf(x * n, y * n);
  });
  return pixels;
}

template <class Sum, class T>
Image<T> meanImage(const Image<T>& samples, int n) {
  return pixelImage<T>(samples.width(), samples.height(), n, [&](int x0, int y0) {
    Sum sum(0.0);
    for (int y = y0; y < y0 + n; ++y)
      for (int x = x0; x < x0 + n; ++x) sum += Sum(samples.at(x, y));
    return T(sum / static_cast<double>(n * n));
  });
}

// A mean of two depths lies on no surface, and a mean of two identities is another's.
bool hasNoMean(const std::string& channel) {
  const std::string name = lowerCase(channel), last = name.substr(name.rfind('.') + 1);
  return last == "z" || last == "zback" || last == "depth" || name.find("crypto") != std::string::npos;
}

Image<float> planeOf(const ExrChannel& channel, const Window& data) {
  Image<float> plane(data.width(), data.height());
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = channel.at(i);
  return plane;
}

bool allFinite(const Image<float>& plane) {
  return std::all_of(plane.data(), plane.data() + plane.size(), [](float value) { return std::isfinite(value); });
}

// Whole numbers, bit for bit.
ExrChannel middleNumbers(const ExrChannel& samples, const Window& data, int n) {
  ExrChannel made{samples.name, samples.type, {}};
  for (int y = n / 2; y < data.height(); y += n)
    for (int x = n / 2; x < data.width(); x += n) {
      const auto* first = samples.bytes.data() + 4 * (static_cast<std::ptrdiff_t>(y) * data.width() + x);
      made.bytes.insert(made.bytes.end(), first, first + 4);
    }
  return made;
}

ExrChannel encoded(const ExrChannel& like, const Image<float>& plane, ChannelEncoder& encoder) {
  ExrChannel made{like.name, like.type, std::vector<std::byte>(plane.size() * bytesOf(like.type))};
  for (std::size_t i = 0; i < plane.size(); ++i) encoder.put(made, i, plane[i]);
  return made;
}

Image<float> componentOf(const Image<glm::vec4>& picture, int c) {
  Image<float> plane(picture.width(), picture.height());
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = picture[i][c];
  return plane;
}

// A channel of the beauty's part, the beauty as the picture has it.
ExrChannel channelOfPixels(const ExrChannel& channel, const OpaqueFile& file, int n, const Image<glm::vec4>& picture,
                           ChannelEncoder& encoder) {
  const Window& data = file.gbuffer.data;
  if (channel.type == PixelType::uint32) return middleNumbers(channel, data, n);
  for (int c = 0; c < 4; ++c)
    if (channel.name == file.choice.beautyChannel[c]) return encoded(channel, componentOf(picture, c), encoder);
  const Image<float> samples = planeOf(channel, data);
  const bool mean = !hasNoMean(channel.name) && channel.name != file.choice.depthChannel && allFinite(samples);
  return encoded(channel, mean ? meansOf(samples, n) : middlesOf(samples, n), encoder);
}

}  // namespace

Window pixelsOf(const Window& samples, int n) {
  return {samples.x0 / n, samples.y0 / n, samples.x1 / n, samples.y1 / n};
}

void expectWholePixels(const std::string& path, const GBuffer& samples, int n) {
  for (const auto& [name, window] : {std::pair("display", samples.display), std::pair("data", samples.data)})
    if (!divides(window, n))
      throw MeaningError(fmt::format(
          "{}: --supersampled {}: found the {} window ({}, {}) to ({}, {}), expected edges at multiples of {}", path, n,
          name, window.x0, window.y0, window.x1, window.y1, n));
}

Image<float> meansOf(const Image<float>& samples, int n) {
  return meanImage<double>(samples, n);
}

Image<glm::vec4> meansOf(const Image<glm::vec4>& samples, int n) {
  return meanImage<glm::dvec4>(samples, n);
}

Image<float> middlesOf(const Image<float>& samples, int n) {
  return pixelImage<float>(samples.width(), samples.height(), n,
                           [&](int x, int y) { return samples.at(x + n / 2, y + n / 2); });
}

Image<std::uint8_t> anyOf(const Image<std::uint8_t>& samples, int n) {
  return pixelImage<std::uint8_t>(samples.width(), samples.height(), n, [&](int x0, int y0) {
    std::uint8_t any = 0;
    for (int y = y0; y < y0 + n; ++y)
      for (int x = x0; x < x0 + n; ++x) any |= samples.at(x, y);
    return any;
  });
}

ExtraLayer pixelsOf(const ExtraLayer& samples, int n) {
  ExtraLayer pixels{samples.name, {}};
  for (const auto& [suffix, plane] : samples.channels)
    pixels.channels.emplace_back(suffix, hasNoMean(suffix) ? middlesOf(plane, n) : meansOf(plane, n));
  return pixels;
}

std::vector<std::string> writePixels(const std::string& path, const OpaqueFile& samples, int n,
                                     const Image<glm::vec4>& picture, const std::vector<ExtraLayer>& layers,
                                     const std::map<std::string, std::string>& attributes) {
  const ExrPart& part = samples.document.parts[static_cast<std::size_t>(samples.choice.beautyPart)];
  NewExr file;
  file.like = &part;
  file.pixelAspect = part.pixelAspect;
  file.display = pixelsOf(samples.gbuffer.display, n);
  file.data = pixelsOf(samples.gbuffer.data, n);
  file.attributes = attributes;
  ChannelEncoder encoder;
  std::vector<ExtraLayer> all = layers;
  if (part.deep) {
    const char* names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; ++c) all.push_back({"", {{names[c], componentOf(picture, c)}}});
  } else {
    for (const ExrChannel& channel : part.channels)
      file.channels.push_back(channelOfPixels(channel, samples, n, picture, encoder));
  }
  std::vector<ExrChannel> added = channelsOf(all, file.data, PixelType::float32, encoder);
  std::move(added.begin(), added.end(), std::back_inserter(file.channels));
  writeNewExr(path, file);
  std::vector<std::string> notes;
  encoder.noteTo(notes);
  for (std::size_t i = 0; i < samples.document.ownParts; ++i)
    if (static_cast<int>(i) != samples.choice.beautyPart)
      notes.push_back(
          fmt::format("part {} is left out: of a picture of samples, the part of its beauty is written",
                      samples.document.parts[i].name.empty() ? std::to_string(i) : samples.document.parts[i].name));
  return notes;
}

}  // namespace pellucid
