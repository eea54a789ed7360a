// Encoded images to float RGBA.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "engine_bridge/scene/textures.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"
#include "gbuffer/image_codec.h"
#include "gbuffer/plain_png.h"

namespace pellucid::gltf {

namespace {

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

StoredImage readImage(const std::vector<std::uint8_t>& bytes, const std::string& format, const std::string& whose) {
  StoredImage image;
  if (readPlainPng(bytes, image)) return image;
  const std::string problem = imageCodec().read(bytes, format, image);
  if (!problem.empty()) throw InputError(printable(whose + " " + problem));
  return image;
}

// The colours of `from`, which has no alpha, in place of those of `to`.
void putColours(const StoredImage& from, StoredImage& to) {
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
  StoredImage image = readImage(bytes, format, whose);
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
