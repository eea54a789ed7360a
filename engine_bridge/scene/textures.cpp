#include "engine_bridge/scene/textures.h"

#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/uri.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr std::size_t kMostTexels = std::size_t{1} << 29;  // 8 GiB of float RGBA in one file
constexpr float kMostUv = 1e6f;

Wrap wrapOf(const JsonView& sampler, const char* key) {
  const std::size_t mode = sampler.unsignedInteger(key, 10497);
  switch (mode) {
    case 10497:
      return Wrap::repeat;
    case 33648:
      return Wrap::mirror;
    case 33071:
      return Wrap::clamp;
    default:
      sampler.at(key).refuse(fmt::format("is {}; expected 10497, 33648 or 33071", mode));
  }
}

Minify minifyOf(const JsonView& sampler) {
  switch (const std::size_t filter = sampler.unsignedInteger("minFilter", 9987)) {
    case 9728:
      return Minify::nearest;
    case 9729:
      return Minify::linear;
    case 9984:
      return Minify::nearestMipNearest;
    case 9985:
      return Minify::linearMipNearest;
    case 9986:
      return Minify::nearestMipLinear;
    case 9987:
      return Minify::linearMipLinear;
    default:
      sampler.at("minFilter").refuse(fmt::format("is {}; expected 9728, 9729 or 9984 to 9987", filter));
  }
}

bool nearestOf(const JsonView& sampler) {
  const std::size_t filter = sampler.unsignedInteger("magFilter", 9729);
  if (filter != 9728 && filter != 9729) {
    sampler.at("magFilter").refuse(fmt::format("is {}; expected 9728 or 9729", filter));
  }
  return filter == 9728;
}

// KHR_texture_transform: translation * rotation * scale. A positive rotation turns UVs counter-clockwise as the image
// is seen, v downwards: what the extension's text, its examples and the common viewers do (its GLSL reads transposed).
glm::mat3 uvTransform(const JsonView& transform, Notes& notes) {
  const auto pair = [&](const char* key, float fallback) {
    glm::vec2 value(fallback);
    if (const std::optional<JsonView> member = transform.find(key)) {
      const std::vector<double> v = member->numbers(2);
      for (int i = 0; i < 2; ++i) {
        const double found = v[static_cast<std::size_t>(i)];
        if (std::abs(found) > static_cast<double>(kMostUv)) {
          member->refuse(fmt::format("is {:g}; expected magnitudes up to {:g}", found, kMostUv));
        }
        value[i] = static_cast<float>(found);
      }
    }
    return value;
  };
  const glm::vec2 offset = pair("offset", 0.0f), scale = pair("scale", 1.0f);
  const double angle = static_cast<double>(transform.number("rotation", 0.0f, -kMostUv, kMostUv, notes));
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  glm::mat3 matrix(1.0f);
  matrix[0] = glm::vec3(c * scale.x, -s * scale.x, 0.0f);
  matrix[1] = glm::vec3(s * scale.y, c * scale.y, 0.0f);
  matrix[2] = glm::vec3(offset, 1.0f);
  return matrix;
}

}  // namespace

TextureRef TextureReader::place(const JsonView& textureInfo, const std::string& material, bool decode) const {
  TextureRef result;
  std::size_t set = textureInfo.unsignedInteger("texCoord", 0);
  if (const std::optional<JsonView> transform = textureInfo.extension("KHR_texture_transform")) {
    set = transform->unsignedInteger("texCoord", set);
    result.uvTransform = uvTransform(*transform, *notes_);
  }
  if (!decode) return result;
  if (set > 1) {
    throw MeaningError(printable(fmt::format("{}: material {}: {} uses TEXCOORD_{}; expected 0 or 1", file_->path(),
                                             material, textureInfo.where(), set)));
  }
  result.texCoord = static_cast<int>(set);
  return result;
}

TextureRef TextureReader::read(const JsonView& textureInfo, TexelUse use, const std::string& material, bool decode) {
  TextureRef result = place(textureInfo, material, decode);
  const JsonView texture = file_->item("textures", textureInfo.at("index"));
  if (decode) result.texture = load(texture, use, -1.0f, material);
  return result;
}

TextureRef TextureReader::readGlossy(const JsonView& textureInfo, float glossiness, const std::string& material,
                                     bool decode) {
  TextureRef result = place(textureInfo, material, decode);
  const JsonView texture = file_->item("textures", textureInfo.at("index"));
  if (decode) result.texture = load(texture, TexelUse::data, glossiness, material);
  return result;
}

Texture TextureReader::open(std::size_t index, TexelUse use, const std::string& material) {
  const JsonView image = file_->item("images", index);
  Texture result;
  const std::optional<JsonView> uri = image.find("uri");
  const bool external = uri && !isDataUri(uri->string());
  result.name = external ? decodePercent(uri->string()) : image.string("name", "");
  if (result.name.empty()) result.name = fmt::format("image {}", index);
  const std::string whose = printable(fmt::format("{}: material {}: texture {}", file_->path(), material, result.name));
  std::vector<std::uint8_t> bytes;
  if (uri) {
    bytes = file_->uriBytes(uri->string(), whose);
  } else {
    const SharedBytes view = file_->viewBytes(file_->item("bufferViews", image.at("bufferView")));
    bytes.assign(view.bytes().begin(), view.bytes().end());
    if (view.file()) view.file()->letGo(view.bytes());
  }
  result.colour = use == TexelUse::colour;
  result.texels = decodeImage(bytes, use, whose, external ? result.name : "", *notes_, &result.fromRec709);
  texels_ += result.texels.size();
  if (texels_ > kMostTexels) {
    throw ResourceError(
        fmt::format("{}: takes the file's textures to {} texels; expected at most {}", whose, texels_, kMostTexels));
  }
  return result;
}

int TextureReader::load(const JsonView& texture, TexelUse use, float glossiness, const std::string& material) {
  // The plain source of a texture that has this extension is for readers without WebP.
  const std::optional<JsonView> webp = texture.extension("EXT_texture_webp");
  std::optional<JsonView> source = webp ? webp->find("source") : std::nullopt;
  if (!source) source = texture.find("source");
  if (!source) {
    const std::optional<JsonView> extensions = texture.find("extensions");
    const std::vector<std::string> names = extensions ? extensions->keys() : std::vector<std::string>{};
    throw MeaningError(
        printable(fmt::format("{}: material {}: {} has no PNG, JPEG or WebP source{}; expected one", file_->path(),
                              material, texture.where(), names.empty() ? "" : ", only " + names.front())));
  }
  const std::size_t index = source->index(file_->count("images"), "images");
  Sampling sampling;
  if (const std::optional<JsonView> reference = texture.find("sampler")) {
    const JsonView sampler = file_->item("samplers", *reference);
    sampling.wrapS = wrapOf(sampler, "wrapS");
    sampling.wrapT = wrapOf(sampler, "wrapT");
    sampling.nearest = nearestOf(sampler);
    sampling.minify = minifyOf(sampler);
  }
  const auto key = std::make_tuple(index, use, sampling, glossiness);
  if (const auto found = loaded_.find(key); found != loaded_.end()) return found->second;
  Texture result = open(index, use, material);
  static_cast<Sampling&>(result) = sampling;
  if (glossiness >= 0.0f)
    for (std::size_t i = 0; i < result.texels.size(); ++i)
      result.texels[i] = glm::vec4(0.0f, 1.0f - glossiness * result.texels[i].a, 0.0f, 1.0f);
  textures_->push_back(std::move(result));
  const int loaded = static_cast<int>(textures_->size()) - 1;
  loaded_.emplace(key, loaded);
  return loaded;
}

}  // namespace pellucid::gltf
