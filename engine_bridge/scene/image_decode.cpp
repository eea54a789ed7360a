// Encoded images to float RGBA, through OpenImageIO from memory.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "engine_bridge/scene/textures.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr int kMostEdge = 16384;  // GL_MAX_TEXTURE_SIZE of the devices we draw with

struct Signature {
  std::string_view bytes;
  std::size_t at;
  const char* format;
};
using namespace std::string_view_literals;
constexpr Signature kSignatures[] = {{"\x89PNG\r\n\x1a\n"sv, 0, "png"},
                                     {"\xff\xd8\xff"sv, 0, "jpg"},
                                     {"WEBP"sv, 8, "webp"},
                                     {"\x76\x2f\x31\x01"sv, 0, "exr"},
                                     {"#?"sv, 0, "hdr"},
                                     {"II*\0"sv, 0, "tif"},
                                     {"MM\0*"sv, 0, "tif"},
                                     {"BM"sv, 0, "bmp"},
                                     {"DDS "sv, 0, "dds"},
                                     {"\0\0\0\x0cjP  \r\n\x87\n"sv, 0, "jp2"},
                                     {"GIF8"sv, 0, "gif"}};

// The content decides, as glTF asks; the name only where there is no signature (TGA has none).
std::string formatOf(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Signature& signature : kSignatures) {
    if (content.size() >= signature.at && content.substr(signature.at).starts_with(signature.bytes))
      return signature.format;
  }
  const std::string extension = std::filesystem::path(name).extension().string();
  return extension.empty() ? "" : extension.substr(1);
}

// 8-bit images have 256 values: no pow for each texel.
std::array<float, 256> srgbTable() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
  return table;
}

float decodeSrgb(float encoded, bool eightBit) {
  static const std::array<float, 256> kTable = srgbTable();
  if (!eightBit) return linearFromSrgb(encoded);
  return kTable[static_cast<std::size_t>(std::lround(std::clamp(encoded, 0.0f, 1.0f) * 255.0f))];
}

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

// An image as it is stored, integers divided by their largest.
struct Samples {
  int width = 0, height = 0, channels = 0;  // at most 4 of them
  bool floats = false, eightBit = false;
  std::optional<Chromaticities> chromaticities;  // of EXR
  std::vector<float> values;
};

std::optional<Chromaticities> statedBy(const OIIO::ImageSpec& spec) {
  const OIIO::ParamValue* stated = spec.find_attribute("chromaticities");
  if (!stated || stated->type() != OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8)) return std::nullopt;
  const auto* numbers = static_cast<const float*>(stated->data());
  const auto pair = [&](int i) { return glm::dvec2(glm::vec2(numbers[2 * i], numbers[2 * i + 1])); };
  return Chromaticities{pair(0), pair(1), pair(2), pair(3)};
}

Samples readImage(const std::vector<std::uint8_t>& bytes, const std::string& format, const std::string& whose) {
  const auto refuse = [&](const std::string& rest) { throw InputError(printable(whose + " " + rest)); };
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // glTF alpha is straight; OIIO would premultiply
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const std::unique_ptr<OIIO::ImageInput> input = format.empty() ? nullptr : OIIO::ImageInput::create(format);
  if (!input) {
    OIIO::geterror();  // taken, or it would be printed later as somebody else's
    refuse(fmt::format("is in no image format that is known ({} bytes); expected PNG or JPEG", bytes.size()));
  }
  if (!input->supports("ioproxy") || !input->set_ioproxy(&memory)) {
    refuse(fmt::format("is a {} image, which cannot be read from memory; expected PNG or JPEG", format));
  }
  OIIO::ImageSpec spec;
  const std::string fileName = "image." + format;
  if (!input->open(fileName, spec, config)) {
    refuse(fmt::format("cannot be read as {}: {}", format, input->geterror()));
  }
  if (spec.width < 1 || spec.height < 1 || spec.width > kMostEdge || spec.height > kMostEdge || spec.depth > 1 ||
      spec.nchannels < 1 || spec.nchannels > 64) {
    refuse(fmt::format("has {}x{} pixels of {} channels; expected 1 to {} pixels a side and 1 to 64 channels",
                       spec.width, spec.height, spec.nchannels, kMostEdge));
  }
  Samples samples;
  samples.width = spec.width;
  samples.height = spec.height;
  samples.channels = std::min(spec.nchannels, 4);
  samples.floats = spec.format.is_floating_point();
  samples.chromaticities = statedBy(spec);
  samples.eightBit = spec.format.basetype == OIIO::TypeDesc::UINT8;
  if (!readSamples(*input, spec, samples.channels, samples.values))
    refuse(fmt::format("is damaged: {}", input->geterror()));
  return samples;
}

// The colours of `from`, which has no alpha, in place of those of `to`.
void putColours(const Samples& from, Samples& to) {
  if (from.channels != 3 || from.width != to.width || from.height != to.height) return;
  for (std::size_t i = 0; 4 * i < to.values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) to.values[4 * i + c] = from.values[3 * i + c];
}

}  // namespace

float linearFromSrgb(float encoded) {
  const double e = std::clamp(static_cast<double>(encoded), 0.0, 1.0);
  return static_cast<float>(e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4));
}

Image<glm::vec4> decodeImage(const std::vector<std::uint8_t>& bytes, TexelUse use, const std::string& whose,
                             const std::string& name, Notes& notes, glm::dmat3* fromRec709) {
  const std::string format = formatOf(bytes, name);
  if (bytes.empty()) throw InputError(printable(whose + " is empty; expected an encoded image"));
  if (!isWholeImage(bytes, format)) {
    throw InputError(printable(fmt::format("{} is a {} image that is cut short: found {} bytes and no end marker",
                                           whose, format, bytes.size())));
  }
  Samples image = readImage(bytes, format, whose);
  if (format == "webp" && image.channels == 4) {
    // OpenImageIO multiplies a WebP's colours by its alpha, in 8 bits and whatever it is asked for.
    if (const auto opaque = withoutWebpAlpha(bytes)) putColours(readImage(*opaque, format, whose), image);
  }
  const bool decode = use == TexelUse::colour && !image.floats;
  Image<glm::vec4> texels(image.width, image.height);
  std::size_t repaired = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float* source = image.values.data() + i * static_cast<std::size_t>(image.channels);
    const bool grey = image.channels < 3;
    glm::vec4 texel(source[0], grey ? source[0] : source[1], grey ? source[0] : source[2], 1.0f);
    if (image.channels == 2) texel.a = source[1];
    if (image.channels == 4) texel.a = source[3];
    for (int c = 0; c < 4; ++c) {
      if (!std::isfinite(texel[c]) || texel[c] < 0.0f) {
        texel[c] = 0.0f;
        ++repaired;
      }
      if (decode && c < 3) texel[c] = decodeSrgb(texel[c], image.eightBit);
    }
    texel.a = std::min(texel.a, 1.0f);
    texels[i] = texel;
  }
  if (fromRec709 && image.chromaticities && image.floats && use == TexelUse::colour)
    if (const std::optional<ColourSpace> own = spaceOf(*image.chromaticities)) *fromRec709 = own->fromRec709;
  if (repaired > 0) notes.add(fmt::format("{} values of {} are negative or not finite; 0 is used", repaired, name));
  return texels;
}

}  // namespace pellucid::gltf
