// The one place that reads and writes images by OpenImageIO, from memory.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "gbuffer/image_codec.h"

namespace pellucid {
namespace {

constexpr int kMostEdge = 16384;  // GL_MAX_TEXTURE_SIZE of the devices we draw with

// Integers are read as stored and divided here: OpenImageIO multiplies by a rounded 1/255.
template <class T>
bool readIntegers(OIIO::ImageInput& input, int channels, std::vector<float>& samples) {
  std::vector<T> raw(samples.size());
  if (!input.read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<T>::value, raw.data())) return false;
  constexpr auto kMost = static_cast<float>(std::numeric_limits<T>::max());
  std::transform(raw.begin(), raw.end(), samples.begin(), [](T value) { return static_cast<float>(value) / kMost; });
  return true;
}

bool readSamples(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channels, std::vector<float>& samples) {
  samples.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                 static_cast<std::size_t>(channels));
  if (spec.format.basetype == OIIO::TypeDesc::UINT8) return readIntegers<std::uint8_t>(input, channels, samples);
  if (spec.format.basetype == OIIO::TypeDesc::UINT16) return readIntegers<std::uint16_t>(input, channels, samples);
  return input.read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, samples.data());
}

std::optional<Chromaticities> statedBy(const OIIO::ImageSpec& spec) {
  const OIIO::ParamValue* stated = spec.find_attribute("chromaticities");
  if (!stated || stated->type() != OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8)) return std::nullopt;
  const auto* numbers = static_cast<const float*>(stated->data());
  const auto pair = [&](int i) { return glm::dvec2(glm::vec2(numbers[2 * i], numbers[2 * i + 1])); };
  return Chromaticities{pair(0), pair(1), pair(2), pair(3)};
}

std::string readImage(const std::vector<std::uint8_t>& bytes, const std::string& format, StoredImage& image) {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // glTF alpha is straight; OIIO would premultiply
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const std::unique_ptr<OIIO::ImageInput> input = format.empty() ? nullptr : OIIO::ImageInput::create(format);
  if (!input) {
    OIIO::geterror();  // taken, or it would be printed later as somebody else's
    return fmt::format("is in no image format that is known ({} bytes); expected PNG or JPEG", bytes.size());
  }
  if (!input->supports("ioproxy") || !input->set_ioproxy(&memory))
    return fmt::format("is a {} image, which cannot be read from memory; expected PNG or JPEG", format);
  OIIO::ImageSpec spec;
  const std::string fileName = "image." + format;
  if (!input->open(fileName, spec, config)) return fmt::format("cannot be read as {}: {}", format, input->geterror());
  if (spec.width < 1 || spec.height < 1 || spec.width > kMostEdge || spec.height > kMostEdge || spec.depth > 1 ||
      spec.nchannels < 1 || spec.nchannels > 64)
    return fmt::format("has {}x{} pixels of {} channels; expected 1 to {} pixels a side and 1 to 64 channels",
                       spec.width, spec.height, spec.nchannels, kMostEdge);
  image.width = spec.width;
  image.height = spec.height;
  image.channels = std::min(spec.nchannels, 4);
  image.floats = spec.format.is_floating_point();
  image.chromaticities = statedBy(spec);
  image.eightBit = spec.format.basetype == OIIO::TypeDesc::UINT8;
  if (!readSamples(*input, spec, image.channels, image.values)) return fmt::format("is damaged: {}", input->geterror());
  return "";
}

std::string writePng(const std::string& path, int width, int height, const std::uint8_t* rgb) {
  const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create("png");
  if (!out) return "no writer of PNG";
  if (out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT8, rgb) && out->close()) return "";
  return out->geterror();
}

constexpr ImageCodec kCodec{readImage, writePng};

}  // namespace
}  // namespace pellucid

extern "C" [[gnu::visibility("default")]] const pellucid::ImageCodec* pellucidImageCodec() {
  return &pellucid::kCodec;
}
